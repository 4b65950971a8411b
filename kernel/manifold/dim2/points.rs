//! Contacts with a ball, of one point at most: two centres, or a centre and a polygon.

use super::super::{LocalManifold, PairInput};
use super::polygonal::Polygonal;
use crate::math::Vector;
use crate::shape::direction;

/// The radii of the two shapes, and the prediction distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) radii: [f32; 2],
    pub(super) prediction: f32,
}

/// Adds the contact point of two points `p`, `q` with a radius each, if they are near enough, and sets the
/// normal from `p` to `q`, or `otherwise` if they coincide.
#[inline]
pub(super) fn push_between(
    p: Vector,
    q: Vector,
    otherwise: Vector,
    limits: Limits,
    feature: u32,
    out: &mut LocalManifold,
) -> Vector {
    let (normal, distance) = direction(q - p).unwrap_or((otherwise, 0.0));
    let separation = distance - limits.radii[0] - limits.radii[1];
    if separation <= limits.prediction {
        out.push(p + normal * (0.5 * (distance + limits.radii[0] - limits.radii[1])), separation, feature);
    } else {
        out.gap = separation;
    }
    normal
}

/// Two balls. The normal of concentric balls is upward.
pub(super) fn collide_points(a: &Polygonal, b: &Polygonal, input: PairInput, out: &mut LocalManifold) {
    let PairInput { pose, prediction, .. } = input;
    let (p, q) = (a.vertices[0], pose.transform(b.vertices[0]));
    out.normal = push_between(p, q, Vector::Y, Limits { radii: [a.radius, b.radius], prediction }, 0, out);
}

/// A polygon `a` and a ball `b`: the edge with the largest separation of the centre, or one of its ends if
/// the centre is beyond it.
pub(super) fn collide_with_point(a: &Polygonal, b: &Polygonal, input: PairInput, out: &mut LocalManifold) {
    let PairInput { pose, prediction, .. } = input;
    let center = pose.transform(b.vertices[0]);
    let limits = Limits { radii: [a.radius, b.radius], prediction };
    let reach = prediction + a.radius + b.radius;
    let mut best = (f32::NEG_INFINITY, 0);
    for (i, (v, n)) in a.vertices.iter().zip(a.normals).enumerate() {
        let height = (center - *v).dot(*n);
        if height > reach {
            out.gap = height - a.radius - b.radius;
            return;
        }
        if height > best.0 {
            best = (height, i);
        }
    }
    let (height, i) = best;
    let (start, end, normal) = (a.vertices[i], a.vertices[a.next(i)], a.normals[i]);
    // The ends of a segment have no normals, so a centre on its line may still be beyond them.
    if height > 0.0 || a.len() == 2 {
        let axis = end - start;
        let corner = if (center - start).dot(axis) < 0.0 {
            Some(start)
        } else if (center - end).dot(axis) > 0.0 {
            Some(end)
        } else {
            None
        };
        if let Some(corner) = corner {
            out.normal = push_between(corner, center, normal, limits, 0, out);
            return;
        }
    }
    let separation = height - a.radius - b.radius;
    if separation <= prediction {
        out.normal = normal;
        out.push(center - normal * (0.5 * (height - a.radius + b.radius)), separation, 0);
    } else {
        out.gap = separation;
    }
}
