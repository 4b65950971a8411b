//! A half-space against everything bounded: the lowest edge's ends.

use super::super::LocalManifold;
use super::clip::pair;
use super::polygonal::Polygonal;
use crate::math::{Pose, Vector};
use crate::shape::HalfSpace;

/// Which shape of the pair the half-space is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    First,
    Second,
}

/// Fills `out` in the half-space's frame, with the normal out of it.
pub(super) fn collide(
    plane: &HalfSpace,
    other: &Polygonal,
    pose: &Pose,
    prediction: f32,
    order: Order,
    out: &mut LocalManifold,
) {
    let normal = plane.normal;
    // The plane's normal and offset in the polygon's frame: only what becomes a point is transformed.
    let down = pose.rotation.inverse_rotate(normal);
    let offset = pose.position.dot(normal);
    let (mut lowest, mut height) = (0, f32::INFINITY);
    for (i, v) in other.vertices.iter().enumerate() {
        let h = v.dot(down);
        if h < height {
            (lowest, height) = (i, h);
        }
    }
    out.normal = normal;
    out.apart = height + offset - other.radius;
    let mut push = |i: usize| {
        let v: Vector = pose.transform(other.vertices[i]);
        let h = other.vertices[i].dot(down) + offset;
        let separation = h - other.radius;
        if separation <= prediction {
            let feature = if order == Order::First { pair(0, i) } else { pair(i, 0) };
            out.push(v - normal * (0.5 * (h + other.radius)), separation, feature);
        }
    };
    if other.len() == 1 {
        push(0);
        return;
    }
    // Of the two edges at the lowest vertex the one that faces the plane more; in the outline's order,
    // so that the points keep their places while the polygon rocks.
    let before = other.previous(lowest);
    if other.normals[before].dot(down) < other.normals[lowest].dot(down) {
        push(before);
        push(lowest);
    } else {
        push(lowest);
        push(other.next(lowest));
    }
}
