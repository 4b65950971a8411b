//! Contacts of balls and segments with radii: a ball with a ball or polygon, and two segments.

use super::super::{LocalManifold, PairInput};
use super::polygonal::{Edge, Facing, Limits, Polygonal, Side, push_between};
use crate::math::Vector;
use crate::tuning::manifold::ALIKE;

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
        let ends = [start, end];
        if let Some(i) = nearest_end(ends.map(|end| center - end), end - start) {
            out.normal = push_between(ends[i], center, normal, limits, 0, out);
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

/// An end of a segment against the other segment.
#[derive(Clone, Copy)]
struct Candidate {
    /// The segment that the end is compared with.
    side: Side,
    /// The index of the end in the other segment.
    end: usize,
    /// The nearest end of the segment, if the end is beyond it.
    corner: Option<usize>,
    /// The height over the segment's line, along its unit normal `axis.perp()`.
    height: f32,
    square: f32,
}

/// Two segments with radii. Parallel segments side by side get two points. Edge normals do not separate
/// segments on one line, so the closest points are computed first.
pub(super) fn collide_segments(a: &Polygonal, b: &Polygonal, input: PairInput, out: &mut LocalManifold) {
    let PairInput { pose, prediction, .. } = input;
    let p = [a.vertices[0], a.vertices[1]];
    let q = [pose.transform(b.vertices[0]), pose.transform(b.vertices[1])];
    let axes = [a.normals[0].perp(), pose.rotation.rotate(b.normals[0].perp())];
    let candidates = [
        candidate(Side::A, p, axes[0], q, 0),
        candidate(Side::A, p, axes[0], q, 1),
        candidate(Side::B, q, axes[1], p, 0),
        candidate(Side::B, q, axes[1], p, 1),
    ];
    let crossing = opposite(candidates[0].height, candidates[1].height)
        && opposite(candidates[2].height, candidates[3].height);
    let best = if crossing { shallowest(&candidates) } else { nearest(&candidates) };
    let reach = prediction + a.radius + b.radius;
    if !crossing && best.square > reach * reach {
        // Another feature may be nearer, by the preference at most.
        out.gap = best.square.sqrt() * (1.0 - ALIKE) - a.radius - b.radius;
        return;
    }

    let (ends, normals, radii) = ([p, q], axes.map(|axis| axis.perp()), [a.radius, b.radius]);
    let (side, this, that) = (best.side, best.side as usize, 1 - best.side as usize);
    let (own, other, up) = (ends[this], ends[that], normals[this]);
    let limits = Limits { radii: [radii[this], radii[that]], prediction };
    let edge = |v: [Vector; 2], backward: bool| {
        if backward {
            Edge { ends: [v[1], v[0]], indices: [1, 0] }
        } else {
            Edge { ends: v, indices: [0, 1] }
        }
    };
    if let (Some(corner), false) = (best.corner, crossing) {
        let (reference, incident) = (edge(own, false), edge(other, false));
        return Facing { side, normal: up, reference, incident, limits }.corners(corner, best.end, out);
    }
    // The side of the segment where the other segment is. The nearest end is on this side too, unless the
    // segments cross or the end lies on the line; then the far end decides.
    let far_end = (other[1 - best.end] - own[0]).dot(up);
    let on_line = best.height.abs() <= 1.0e-6 * far_end.abs();
    let faces_left = if crossing || on_line { far_end > 0.0 } else { best.height > 0.0 };
    let normal = up * if faces_left { 1.0 } else { -1.0 };
    // Counter-clockwise, an edge with its normal on the right runs forward, on the left backward.
    let is_backward = normal.perp().dot(other[1] - other[0]) > 0.0;
    let (reference, incident) = (edge(own, faces_left), edge(other, is_backward));
    Facing { side, normal, reference, incident, limits }.contact(false, out);
}

#[inline]
fn opposite(a: f32, b: f32) -> bool {
    (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)
}

fn candidate(side: Side, own: [Vector; 2], axis: Vector, other: [Vector; 2], end: usize) -> Candidate {
    let from = [other[end] - own[0], other[end] - own[1]];
    let height = from[0].dot(axis.perp());
    let corner = nearest_end(from, axis);
    let square = corner.map_or(height * height, |c| from[c].length_squared());
    Candidate { side, end, corner, height, square }
}

/// The end of a segment along `axis` that is nearest to a point beyond it; `None` if the point is beside the
/// segment. `from` leads from each end to the point.
#[inline(always)]
fn nearest_end(from: [Vector; 2], axis: Vector) -> Option<usize> {
    if from[0].dot(axis) < 0.0 {
        Some(0)
    } else if from[1].dot(axis) > 0.0 {
        Some(1)
    } else {
        None
    }
}

/// The end with the least depth behind the other segment's line.
fn shallowest(candidates: &[Candidate; 4]) -> Candidate {
    let mut best = candidates[0];
    for c in &candidates[1..] {
        if c.height.abs() < best.height.abs() * (1.0 - ALIKE) {
            best = *c;
        }
    }
    best
}

/// The nearest end. Of equally near ends, an end over the segment comes before an end beyond it.
fn nearest(candidates: &[Candidate; 4]) -> Candidate {
    let mut best = candidates[0];
    for c in &candidates[1..] {
        let nearer = c.square < best.square * (1.0 - ALIKE);
        let as_near = c.square <= best.square * (1.0 + ALIKE);
        if nearer || (as_near && best.corner.is_some() && c.corner.is_none()) {
            best = *c;
        }
    }
    best
}
