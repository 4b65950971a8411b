//! A half-space against bounded shapes: the ends of the lowest edge.

use super::super::{LocalManifold, PairInput};
use super::clip::pair;
use super::polygonal::Polygonal;
use crate::math::Vector;
use crate::shape::HalfSpace;

/// Fills `out` in the half-space's frame, with the normal out of it.
pub(super) fn collide(plane: &HalfSpace, other: &Polygonal, input: PairInput, out: &mut LocalManifold) {
    let PairInput { pose, prediction, .. } = input;
    let normal = plane.normal;
    // The plane's normal and offset in the polygon's frame, so that only contact points are transformed.
    let down = pose.rotation.inverse_rotate(normal);
    let offset = pose.position.dot(normal);
    let (lowest, height) = other.lowest(down);
    out.normal = normal;
    out.gap = height + offset - other.radius;
    let mut push = |i: usize| {
        let v: Vector = pose.transform(other.vertices[i]);
        let h = other.vertices[i].dot(down) + offset;
        let separation = h - other.radius;
        if separation <= prediction {
            out.push(v - normal * (0.5 * (h + other.radius)), separation, pair(0, i));
        }
    };
    if other.len() == 1 {
        push(0);
        return;
    }
    // In the order of the outline, so that points keep their order while the polygon rocks.
    other.edge(other.edge_facing(down, lowest)).indices.into_iter().for_each(push);
}
