//! The segments of a surface: their ends, and contacts with their side alone.

use super::polygonal::{Buffer, Edge, Facing, Limits, Side, view};
use crate::manifold::border::{Border, is_beside};
use crate::manifold::pairs::collide_pair;
use crate::manifold::{LocalManifold, LocalPoint, PairInput};
use crate::math::{F32x4, Vector};
use crate::shape::{Curved, Segment, Shape, direction};
use crate::tuning::contact::DEEP;
use crate::tuning::manifold::MARGIN;

/// The unit normal on the left of a segment; `None` if it has no length.
pub(in crate::manifold) fn face_normal([a, b]: [Vector; 2]) -> Option<Vector> {
    direction(b - a).map(|(axis, _)| axis.perp())
}

/// Vectors across four segments, of any length; 0 without length.
#[inline(always)]
pub(in crate::manifold) fn facing([a, b]: &[Vector<F32x4>; 2]) -> Vector<F32x4> {
    let along = *b - *a;
    Vector { x: -along.y, y: along.x }
}

/// The ends of a segment with the given normal.
pub(in crate::manifold) fn borders([a, b]: [Vector; 2], normal: Vector) -> [Border; 2] {
    let axis = -normal.perp();
    let depth = (b - a).dot(axis).abs();
    let end = |corner, outward| Border { corner, along: Vector::ZERO, outward, depth };
    [end(a, -axis), end(b, axis)]
}

/// A convex shape to collide with several facets in sequence.
pub(in crate::manifold) struct Convex<'a> {
    pub shape: &'a Shape,
}

/// Calls `f` with a shape to collide with facets.
pub(in crate::manifold) fn with_convex<R>(shape: &Shape, f: impl FnOnce(&Convex) -> R) -> R {
    f(&Convex::of(shape))
}

impl<'a> Convex<'a> {
    /// The shape.
    pub fn of(shape: &'a Shape) -> Self {
        Self { shape }
    }

    /// Fills `out` with the contact of a single segment; see [`collide_pair`].
    pub fn collide_facet(&self, [a, b]: [Vector; 2], input: PairInput, out: &mut LocalManifold) {
        let facet = Shape::Segment(Segment { a, b });
        collide_pair(&facet, self.shape, input, out);
    }

    /// Fills `out` with the contact of a segment's side alone, where the shape is over it. `normal` is the
    /// segment's, towards the shape.
    pub fn collide_face(
        &self,
        corners: [Vector; 2],
        normal: Vector,
        input: PairInput,
        out: &mut LocalManifold,
    ) {
        (out.count, out.gap) = (0, 0.0);
        if let Shape::Curved(other) = self.shape {
            return collide_curved(corners, normal, other, input, out);
        }
        let PairInput { pose, prediction, .. } = input;
        let mut room = Buffer::EMPTY;
        let Some(polygon) = view(self.shape, &mut room) else { return };
        let facing = pose.rotation.inverse_rotate(normal);
        let (lowest, _) = polygon.lowest(facing);
        let vertex = pose.transform(polygon.vertices[lowest]);
        let [a, b] = corners;
        // Counter-clockwise, the edge has its normal on the right.
        let forward = normal.dot((b - a).perp()) < 0.0;
        let (ends, indices) = if forward { ([a, b], [0, 1]) } else { ([b, a], [1, 0]) };
        let separation = (vertex - ends[0]).dot(normal) - polygon.radius;
        if !(separation <= prediction) {
            out.gap = separation;
            return;
        }
        if polygon.len() == 1 {
            if !is_beside(&borders(corners, normal), vertex) {
                out.normal = normal;
                out.push(vertex - normal * (0.5 * (separation + 2.0 * polygon.radius)), separation, 0);
            }
            return;
        }
        Facing {
            side: Side::A,
            normal,
            reference: Edge { ends, indices },
            incident: polygon.edge(polygon.edge_facing(facing, lowest)).moved(pose),
            limits: Limits { radii: [0.0, polygon.radius], prediction },
        }
        .contact(false, out);
        let tangent = normal.perp();
        let along = |p: &LocalPoint| (p.point - ends[0]).dot(tangent);
        let length = (ends[1] - ends[0]).dot(tangent);
        if out.count == 1 && !(-MARGIN * length..=(1.0 + MARGIN) * length).contains(&along(&out.points[0])) {
            out.count = 0;
        }
    }
}

/// Reduces `points` to at most two points with the same support: the outermost two or, where the middle hangs
/// deeper, the deepest and an outermost point.
pub(in crate::manifold) fn few_points(points: &[LocalPoint], out: &mut LocalManifold) {
    let tangent = out.normal.perp();
    let along = |p: &LocalPoint| p.point.dot(tangent);
    let (mut first, mut last) = (points[0], points[0]);
    for p in points {
        if along(p) < along(&first) {
            first = *p;
        }
        if along(p) > along(&last) {
            last = *p;
        }
    }
    let deepest = *points.iter().min_by(|p, q| p.separation.total_cmp(&q.separation)).unwrap_or(&first);
    let (length, way) = (along(&last) - along(&first), along(&deepest) - along(&first));
    let sag = first.separation + (last.separation - first.separation) * (way / length) - deepest.separation;
    if deepest != first && deepest != last && sag > MARGIN * length {
        if first.separation <= last.separation { last = deepest } else { first = deepest }
    }
    out.count = 0;
    [first, last].into_iter().take(points.len().min(2)).for_each(|p| out.add(p));
}

fn collide_curved(
    corners: [Vector; 2],
    normal: Vector,
    other: &Curved,
    input: PairInput,
    out: &mut LocalManifold,
) {
    let PairInput { pose, prediction, .. } = input;
    let facing = pose.rotation.inverse_rotate(-normal);
    let lowest = pose.transform(other.support(facing));
    let separation = (lowest - corners[0]).dot(normal);
    if !(separation <= prediction) {
        out.gap = separation;
        return;
    }
    if !is_beside(&borders(corners, normal), lowest) {
        (out.normal, out.radii) = (normal, [0.0, other.curvature_radius(facing)]);
        out.push(lowest - normal * (0.5 * separation), separation, 0);
    } else if separation < -DEEP * other.half.min_element() {
        // A shape deep under a side need not be over it.
        let [a, b] = corners;
        let segment = Shape::Segment(Segment { a, b });
        collide_pair(&segment, &Shape::Curved(*other), input, out);
    }
}
