//! Contacts of convex shapes in the plane: at most two points, midway between the surfaces.
//!
//! Every bounded shape is seen as a polygon with a radius: a ball has one vertex, a capsule or segment
//! two, the others three or more; ellipses are curves. The function of a pair depends on the numbers of vertices only, so that seven kinds of
//! shapes need five functions. (Capsules and rounded polygons as polygons with a radius, pairs of vertices as feature ids, and
//! the early exit by a cached edge follow ideas of E. Catto's Box2D v3.)

mod clip;
mod cuboids;
mod curved;
mod facet;
mod half_space;
mod points;
mod polygonal;
mod polygons;
mod segments;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_curved;
#[cfg(test)]
pub(super) mod tests_pairs;

use super::{FeatureCache, LocalManifold};
use crate::math::{Angular, Pose, Rot};
use crate::shape::Shape;
pub(super) use facet::{Border, Convex, borders, face_normal, facing, few_points, with_convex};
use polygonal::{Buffer, Polygonal};

/// Centres farther apart than this, in metres, have no contact: their squares would overflow.
const FARTHEST: f32 = 1.0e15;

/// Does nothing, and returns infinity: shapes in the plane have no rims. `dim3` has the function for those in space.
pub fn lead_rims(_: [&Shape; 2], _: Rot, _: &Pose, _: Angular, _: f32, _: &mut LocalManifold) -> f32 {
    f32::INFINITY
}

/// The contact of shape `a` and shape `b`, given the pose of `b` in `a`'s frame; the result is in `a`'s
/// frame with the normal from `a` to `b`.
///
/// `out` is cleared first and stays empty if the surfaces are farther apart than `prediction` metres,
/// for composite and foreign shapes and for two half-spaces. All points have a separation of at most `prediction`. The normal of overlapping
/// shapes is that of the least penetration; if all directions are equal, as for coinciding centres, it is a fixed one.
/// Segments are two-sided.
///
/// `cache` must be that of the same pair in the same order (or [`FeatureCache::NONE`]). Polygons test the cached edge first for
/// a separation, and keep it as the reference while it is as good as any other, so that resting contacts do not flip. Feature
/// ids pair a vertex of `a` (upper 16 bits) with a vertex of `b` (lower 16 bits), whichever polygon has the reference edge.
/// Contacts of one point at most have id 0.
///
/// Poses that are not finite give no points, nor do numbers that overflow.
pub fn collide(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    *out = LocalManifold::default();
    if !(pose_b_in_a.position.abs().max_element() < FARTHEST) || !pose_b_in_a.rotation.is_finite() {
        return;
    }
    use Shape::{Ball, Capsule, Composite, Cuboid, Curved, Foreign, HalfSpace, Hull, Segment, Triangle};
    // All pairs by name: a new shape does not compile until its pairs are here.
    match (a, b) {
        (Cuboid(a), Cuboid(b)) => cuboids::collide(a, b, pose_b_in_a, prediction, cache, out),
        (HalfSpace(a), Curved(b)) => curved::half_space(a.normal, b, pose_b_in_a, prediction, out),
        (Curved(a), HalfSpace(b)) => {
            let pose = pose_b_in_a.inverse();
            curved::half_space(b.normal, a, &pose, prediction, out);
            *out = out.flipped(&pose);
        }
        (HalfSpace(a), b) => {
            let mut room = Buffer::EMPTY;
            if let Some(b) = polygonal::view(b, &mut room) {
                half_space::collide(a, &b, pose_b_in_a, prediction, half_space::Order::First, out);
            }
        }
        (a, HalfSpace(b)) => {
            let mut room = Buffer::EMPTY;
            if let Some(a) = polygonal::view(a, &mut room) {
                let pose = pose_b_in_a.inverse();
                half_space::collide(b, &a, &pose, prediction, half_space::Order::Second, out);
                *out = out.flipped(&pose);
            }
        }
        (
            Ball(_) | Capsule(_) | Cuboid(_) | Hull(_) | Triangle(_) | Segment(_),
            Ball(_) | Capsule(_) | Cuboid(_) | Hull(_) | Triangle(_) | Segment(_),
        ) => {
            let (mut room_a, mut room_b) = (Buffer::EMPTY, Buffer::EMPTY);
            if let (Some(a), Some(b)) = (polygonal::view(a, &mut room_a), polygonal::view(b, &mut room_b)) {
                collide_polygonal(&a, &b, pose_b_in_a, prediction, cache, out);
            }
        }
        (Curved(a), Curved(b)) => curved::collide_round(a, b, pose_b_in_a, prediction, out),
        (Ball(_) | Capsule(_) | Cuboid(_) | Hull(_) | Triangle(_) | Segment(_), Curved(b)) => {
            let mut room = Buffer::EMPTY;
            if let Some(a) = polygonal::view(a, &mut room) {
                curved::collide(&a, b, pose_b_in_a, prediction, out);
            }
        }
        (Curved(a), Ball(_) | Capsule(_) | Cuboid(_) | Hull(_) | Triangle(_) | Segment(_)) => {
            let (pose, mut room) = (pose_b_in_a.inverse(), Buffer::EMPTY);
            if let Some(b) = polygonal::view(b, &mut room) {
                curved::collide(&b, a, &pose, prediction, out);
                *out = out.flipped(&pose);
            }
        }
        // Composites are collided part by part, and foreign shapes by their `ManifoldSource`.
        (
            Ball(_) | Capsule(_) | Cuboid(_) | Hull(_) | Triangle(_) | Segment(_) | Curved(_) | Composite(_)
            | Foreign(_),
            Composite(_) | Foreign(_),
        )
        | (
            Composite(_) | Foreign(_),
            Ball(_) | Capsule(_) | Cuboid(_) | Hull(_) | Triangle(_) | Segment(_) | Curved(_),
        ) => {}
    }
    if !matches!((a, b), (Curved(_), _) | (_, Curved(_))) {
        out.radii = [a.radius(), b.radius()];
    }
    drop_unusable(out);
}

/// Drops a contact whose numbers overflowed, as they do with sizes out of all proportion.
#[inline]
fn drop_unusable(out: &mut LocalManifold) {
    if out.count == 0 {
        return;
    }
    // `x * 0.0` is 0 unless x is infinite or NaN.
    let mut zero = 0.0;
    for p in out.points() {
        zero += p.point.x * 0.0 + p.point.y * 0.0 + p.separation * 0.0;
    }
    if !((out.normal.length_squared() - 1.0).abs() < 1.0e-3 && zero == 0.0) {
        out.count = 0;
    }
}

fn collide_polygonal(
    a: &Polygonal,
    b: &Polygonal,
    pose: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    match (a.len(), b.len()) {
        (1, 1) => points::collide_points(a, b, pose, prediction, out),
        (_, 1) => points::collide_with_point(a, b, pose, prediction, out),
        (1, _) => {
            let inverse = pose.inverse();
            points::collide_with_point(b, a, &inverse, prediction, out);
            *out = out.flipped(&inverse);
        }
        (2, 2) => segments::collide(a, b, pose, prediction, out),
        _ => polygons::collide(a, b, pose, prediction, cache, out),
    }
}
