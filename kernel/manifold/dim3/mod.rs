//! Contact manifolds in space. `dim2` has the same function for the plane.
//!
//! Balls and capsules have closed forms where there are any; two boxes have a path of their own; all
//! other pairs of polyhedra (with radii) share [`convex`].

mod clip;
mod convex;
mod cuboids;
mod gjk;
mod half_space;
#[cfg(test)]
mod near_tests;
#[cfg(test)]
mod oracle;
mod reduce;
mod round;
mod sat;
#[cfg(test)]
mod tests;
mod view;

use super::{FeatureCache, LocalManifold};
use crate::math::{Pose, Vector};
use crate::shape::{Capsule, Segment, Shape};
use view::{Small, View};

/// Centres farther apart than this, in metres, are not looked at: squares would overflow.
const FARTHEST: f32 = 1.0e15;

/// The contact of two shapes, `pose_b_in_a` being where B is in A's frame.
///
/// `out` gets the points no farther apart than `prediction` metres, none if the pair has no contact, a
/// pose or size is not finite, or no function knows the pair (two half-spaces, foreign shapes). Give
/// the `cache` of the same pair from the step before, or [`FeatureCache::NONE`].
pub fn collide(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    (out.count, out.apart) = (0, 0.0);
    if !(pose_b_in_a.position.abs().max_element() < FARTHEST) || !pose_b_in_a.rotation.is_finite() {
        return;
    }
    if let (Shape::Cuboid(a), Shape::Cuboid(b)) = (a, b) {
        cuboids::collide(a.half, b.half, pose_b_in_a, prediction, cache, out);
    } else if rank(a) > rank(b) {
        let inverse = pose_b_in_a.inverse();
        dispatch(b, a, &inverse, prediction, cache, out);
        *out = out.flipped(&inverse);
    } else {
        dispatch(a, b, pose_b_in_a, prediction, cache, out);
    }
    drop_unusable(out);
}

/// The functions below are written for pairs in this order.
fn rank(shape: &Shape) -> u8 {
    match shape {
        Shape::HalfSpace(_) => 0,
        Shape::Cuboid(_) | Shape::Hull(_) | Shape::Triangle(_) => 1,
        Shape::Capsule(_) | Shape::Segment(_) => 2,
        Shape::Ball(_) => 3,
        Shape::Foreign(_) => 4,
    }
}

/// Sizes out of all proportion can overflow on the way: no contact then, rather than a bad one.
#[inline]
fn drop_unusable(out: &mut LocalManifold) {
    if out.count == 0 {
        return;
    }
    // Nothing times a finite number is nothing.
    let mut nothing = 0.0;
    for p in out.points() {
        nothing += p.point.x * 0.0 + p.point.y * 0.0 + p.point.z * 0.0 + p.separation * 0.0;
    }
    if !((out.normal.length_squared() - 1.0).abs() < 1.0e-3 && nothing == 0.0) {
        out.count = 0;
    }
}

fn dispatch(
    a: &Shape,
    b: &Shape,
    pose: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    let center = pose.position;
    match (a, b) {
        (Shape::HalfSpace(a), b) => half_space::collide(a.normal, b, pose, prediction, out),
        (Shape::Ball(a), Shape::Ball(b)) => round::balls(a.radius, center, b.radius, prediction, out),
        (Shape::Cuboid(a), Shape::Ball(b)) => round::cuboid_ball(a.half, center, b.radius, prediction, out),
        (Shape::Triangle(a), Shape::Ball(b)) => round::triangle_ball(a, center, b.radius, prediction, out),
        (Shape::Capsule(_) | Shape::Segment(_), Shape::Ball(b)) => {
            if let Some(a) = as_capsule(a) {
                round::capsule_ball(&a, center, b.radius, prediction, out);
            }
        }
        (Shape::Capsule(_) | Shape::Segment(_), _) => {
            if let (Some(a), Some(b)) = (as_capsule(a), as_capsule(b)) {
                round::capsules(&a, &b, pose, prediction, out);
            }
        }
        _ => polyhedra(a, b, pose, prediction, cache, out),
    }
}

/// Two shapes with polyhedral cores. Apart from the others for the sake of its large stack frame.
#[inline(never)]
fn polyhedra(
    a: &Shape,
    b: &Shape,
    pose: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    with_view(a, |a| with_view(b, |b| convex::collide(a, b, pose, prediction, cache, out)));
}

fn as_capsule(shape: &Shape) -> Option<Capsule> {
    match shape {
        Shape::Capsule(s) => Some(*s),
        Shape::Segment(Segment { a, b }) => Some(Capsule { a: *a, b: *b, radius: 0.0 }),
        _ => None,
    }
}

/// Calls `f` with the polyhedral core of a shape, if it has one.
#[inline(always)]
fn with_view(shape: &Shape, f: impl FnOnce(&View)) {
    let small = match shape {
        Shape::Hull(hull) => return f(&View::from(&**hull)),
        Shape::Cuboid(s) => Small::cuboid(s.half),
        Shape::Triangle(s) => Small::triangle([s.a, s.b, s.c]),
        Shape::Capsule(s) => Small::capsule(s),
        Shape::Segment(s) => Small::segment(s.a, s.b, 0.0),
        Shape::Ball(s) => Small::point(Vector::ZERO, s.radius),
        Shape::HalfSpace(_) | Shape::Foreign(_) => return,
    };
    f(&small.view());
}
