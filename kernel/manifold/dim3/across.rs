//! Where an edge crosses a face that it nearly lies in.
//!
//! Two edges touch in one point. A thin rod on the edge of another would rock on that, from one of its own edges to the next:
//! the other end of the line across its face is hardly farther from the surface. So that end is a point, too.

use super::view::View;
use crate::math::{Vector, max, min};
use crate::shape::Edge;

/// Faces with a smaller cosine to the normal are not lain in.
const FACING: f32 = 0.5;

/// The end of the line along which an edge passes over the face of `reference` beside `edge`, of the two ends the one
/// farther from that face: the point on the edge, and its distance from the face along `normal`. The ends of the edge are in
/// the frame of `reference`; `normal` is the unit normal of the contact, out of `reference`.
pub(super) fn far_end(
    reference: &View,
    edge: &Edge,
    ends: [Vector; 2],
    normal: Vector,
) -> Option<(Vector, f32)> {
    // A segment has no faces.
    let [left, right] = [edge.left, edge.right].map(|face| reference.faces.get(face as usize));
    let (left, right) = (left?, right?);
    let face = if left.normal.dot(normal) > right.normal.dot(normal) { left } else { right };
    let cosine = face.normal.dot(normal);
    if cosine < FACING {
        return None;
    }
    let along = ends[1] - ends[0];
    let (mut low, mut high) = (0.0f32, 1.0f32);
    let outline = &reference.loops[face.first as usize..(face.first + face.count) as usize];
    for (i, tail) in outline.iter().enumerate() {
        let head = outline[(i + 1) % outline.len()];
        let [tail, head] = [*tail, head].map(|corner| reference.vertices[corner as usize]);
        let outward = (head - tail).cross(normal);
        let (start, rate) = (outward.dot(ends[0] - tail), outward.dot(along));
        if rate > 0.0 {
            high = min(high, -start / rate);
        } else if rate < 0.0 {
            low = max(low, -start / rate);
        } else if start > 0.0 {
            return None;
        }
    }
    if !(low < high) {
        return None;
    }
    let end = |t: f32| {
        let point = ends[0] + along * t;
        (point, (face.normal.dot(point) - face.offset) / cosine)
    };
    let (first, last) = (end(low), end(high));
    Some(if first.1 > last.1 { first } else { last })
}
