//! Contacts of convex shapes in the plane: at most two points, midway between the surfaces.
//!
//! This file chooses the function of each pair, and has the function of half-spaces.
//!
//! Every bounded shape is treated as a polygon with a radius: a ball has one vertex, a capsule or segment
//! two, other polygons three or more; ellipses are curves. The function of a pair depends only on the numbers
//! of vertices, so seven kinds of shapes need five functions. (Capsules and rounded polygons as polygons with
//! a radius, pairs of vertices as feature ids, and the early exit by a cached edge follow ideas of E. Catto's
//! Box2D v3.)

mod curved;
mod facet;
mod polygonal;
mod polygons;
mod round;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_curved;
#[cfg(test)]
pub(super) mod tests_pairs;

use super::{LocalManifold, PairInput};
use crate::math::{Angular, Pose, Rot, Vector};
use crate::shape::{HalfSpace, Shape};
pub(super) use facet::{Convex, borders, face_normal, facing, few_points, with_convex};
use polygonal::{Buffer, Polygonal};
pub(super) use polygons::collide_cuboids;

/// Does nothing, and returns infinity: shapes in the plane have no rims. `dim3` has the function for shapes
/// in space.
pub fn midstep_rims(_: [&Shape; 2], _: Rot, _: &Pose, _: Angular, _: f32, _: &mut LocalManifold) -> f32 {
    f32::INFINITY
}

/// The order of the shapes in a pair for [`dispatch`].
pub(super) fn rank(shape: &Shape) -> u8 {
    match shape {
        Shape::HalfSpace(_) => 0,
        Shape::Curved(_) => 2,
        Shape::Composite(_) | Shape::Foreign(_) => 3,
        _ => 1,
    }
}

/// The feature of a point of the swapped pair: A's feature is in the upper 16 bits.
pub(super) fn swapped_feature(feature: u32) -> u32 {
    feature.rotate_left(16)
}

/// The function of each pair, all by name: a new shape does not compile until its pairs are here.
pub(super) fn dispatch(a: &Shape, b: &Shape, input: PairInput, out: &mut LocalManifold) {
    use Shape::{Ball, Capsule, Composite, Cuboid, Curved, Foreign, HalfSpace, Hull, Segment, Triangle};
    let (mut room_a, mut room_b) = (Buffer::EMPTY, Buffer::EMPTY);
    match (a, b) {
        (HalfSpace(a), Curved(b)) => curved::half_space(a.normal, b, input, out),
        (HalfSpace(a), b) => {
            if let Some(b) = polygonal::view(b, &mut room_b) {
                half_space(a, &b, input, out);
            }
        }
        (
            Ball(_) | Capsule(_) | Cuboid(_) | Hull(_) | Triangle(_) | Segment(_),
            Ball(_) | Capsule(_) | Cuboid(_) | Hull(_) | Triangle(_) | Segment(_),
        ) => {
            if let (Some(a), Some(b)) = (polygonal::view(a, &mut room_a), polygonal::view(b, &mut room_b)) {
                collide_polygonal(&a, &b, input, out);
            }
        }
        (Curved(a), Curved(b)) => curved::collide_round(a, b, input, out),
        (Ball(_) | Capsule(_) | Cuboid(_) | Hull(_) | Triangle(_) | Segment(_), Curved(b)) => {
            if let Some(a) = polygonal::view(a, &mut room_a) {
                curved::collide(&a, b, input, out);
            }
        }
        // Composites are collided part by part, and foreign shapes by their `ManifoldSource`. `collide` swaps
        // the other pairs.
        (_, Composite(_) | Foreign(_) | HalfSpace(_)) | (Curved(_) | Composite(_) | Foreign(_), _) => {}
    }
}

fn collide_polygonal(a: &Polygonal, b: &Polygonal, input: PairInput, out: &mut LocalManifold) {
    match (a.len(), b.len()) {
        (1, 1) => round::collide_points(a, b, input, out),
        (_, 1) => round::collide_with_point(a, b, input, out),
        (1, _) => {
            let inverse = input.pose.inverse();
            round::collide_with_point(b, a, PairInput { pose: &inverse, ..input }, out);
            *out = out.flipped(&inverse);
        }
        (2, 2) => round::collide_segments(a, b, input, out),
        _ => polygons::collide(a, b, input, out),
    }
}

/// A half-space against a bounded shape: the ends of the lowest edge. Fills `out` in the half-space's frame,
/// with the normal out of it.
fn half_space(plane: &HalfSpace, other: &Polygonal, input: PairInput, out: &mut LocalManifold) {
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
            out.push(v - normal * (0.5 * (h + other.radius)), separation, polygonal::pair(0, i));
        }
    };
    if other.len() == 1 {
        push(0);
        return;
    }
    // In the order of the outline, so that points keep their order while the polygon rocks.
    other.edge(other.edge_facing(down, lowest)).indices.into_iter().for_each(push);
}
