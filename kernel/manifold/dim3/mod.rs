//! Contact manifolds in space. `dim2` has the same functions for the plane.
//!
//! Balls and capsules have closed forms where they exist, two boxes have a function of their own, and all other pairs of
//! polyhedra (with radii) share [`convex`]. What is round about an axis is in [`curved`].

mod across;
mod axis;
mod clip;
mod convex;
mod cuboids;
mod curved;
mod facet;
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
#[cfg(test)]
pub(super) mod tests_pairs;
#[cfg(test)]
mod tests_triangle;
mod triangle;
mod view;

use super::{FeatureCache, LocalManifold};
use crate::math::{Pose, Vector};
use crate::shape::{Capsule, Curved, Segment, Shape};
pub(super) use cuboids::collide as collide_cuboids;
pub use curved::lead_rims;
pub(super) use facet::{Convex, borders, face_normal, facing, few_points, with_convex};
use view::{Small, View};

/// The order of the shapes in a pair for [`dispatch`].
pub(super) fn rank(shape: &Shape) -> u8 {
    match shape {
        Shape::HalfSpace(_) => 0,
        Shape::Cuboid(_) | Shape::Hull(_) | Shape::Triangle(_) => 1,
        Shape::Capsule(_) | Shape::Segment(_) => 2,
        Shape::Curved(_) => 3,
        Shape::Ball(_) => 4,
        Shape::Composite(_) | Shape::Foreign(_) => 5,
    }
}

/// The feature of a point of the swapped pair: it names no order.
pub(super) fn swapped_feature(feature: u32) -> u32 {
    feature
}

/// The function of each pair, all by name: a new shape does not compile until its pairs are here.
pub(super) fn dispatch(
    a: &Shape,
    b: &Shape,
    pose: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    use Shape::{Ball, Capsule, Composite, Cuboid, Curved, Foreign, HalfSpace, Hull, Segment, Triangle};
    let center = pose.position;
    match (a, b) {
        (HalfSpace(a), Curved(b)) => curved::half_space(a.normal, b, pose, prediction, cache, out),
        (HalfSpace(a), b) => half_space::collide(a.normal, b, pose, prediction, out),
        (Ball(a), Ball(b)) => round::balls(a.radius, center, b.radius, prediction, out),
        (Cuboid(a), Ball(b)) => round::cuboid_ball(a.half, center, b.radius, prediction, out),
        (Triangle(a), Ball(b)) => round::triangle_ball(a, center, b.radius, prediction, out),
        (Capsule(a), Ball(b)) => round::capsule_ball(a, center, b.radius, prediction, out),
        (Segment(a), Ball(b)) => round::capsule_ball(&capsule(a), center, b.radius, prediction, out),
        (Curved(a), Ball(b)) => curved::ball(a, center, b.radius, prediction, out),
        (Capsule(a), Capsule(b)) => round::capsules(a, b, pose, prediction, out),
        (Capsule(a), Segment(b)) => round::capsules(a, &capsule(b), pose, prediction, out),
        (Segment(a), Capsule(b)) => round::capsules(&capsule(a), b, pose, prediction, out),
        (Segment(a), Segment(b)) => round::capsules(&capsule(a), &capsule(b), pose, prediction, out),
        (Curved(a), Curved(b)) => curved::frusta(a, b, pose, prediction, cache, out),
        (Cuboid(_) | Hull(_) | Triangle(_) | Capsule(_) | Segment(_), Curved(b)) => {
            curved_with(a, b, pose, prediction, cache, out);
        }
        (Hull(_), Ball(_))
        | (Cuboid(_) | Hull(_) | Triangle(_), Cuboid(_) | Hull(_) | Triangle(_) | Capsule(_) | Segment(_)) => {
            polyhedra(a, b, pose, prediction, cache, out);
        }
        // Composites are collided part by part, and foreign shapes by their `ManifoldSource`.
        (_, Composite(_) | Foreign(_)) => {}
        // `collide` swaps these, or has taken them.
        (
            Cuboid(_) | Hull(_) | Triangle(_) | Capsule(_) | Segment(_) | Curved(_) | Ball(_) | Composite(_)
            | Foreign(_),
            HalfSpace(_),
        )
        | (
            Capsule(_) | Segment(_) | Curved(_) | Ball(_) | Composite(_) | Foreign(_),
            Cuboid(_) | Hull(_) | Triangle(_),
        )
        | (Curved(_) | Ball(_) | Composite(_) | Foreign(_), Capsule(_) | Segment(_))
        | (Ball(_) | Composite(_) | Foreign(_), Curved(_))
        | (Composite(_) | Foreign(_), Ball(_)) => {
            debug_assert!(false, "shapes come in the order of their ranks");
        }
    }
}

/// A shape with a polyhedral core and a frustum. Not inlined, since its stack frame is large.
#[inline(never)]
fn curved_with(
    a: &Shape,
    b: &Curved,
    pose: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    with_view(a, |a| a.map(|a| curved::with_polyhedron(a, b, pose, prediction, cache, out)));
}

/// Two shapes with polyhedral cores. Not inlined, since its stack frame is large.
#[inline(never)]
fn polyhedra(
    a: &Shape,
    b: &Shape,
    pose: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    with_view(a, |a| {
        with_view(b, |b| {
            if let (Some(a), Some(b)) = (a, b) {
                convex::collide(a, b, pose, prediction, cache, out);
            }
        });
    });
}

/// A segment as a capsule without radius.
fn capsule(segment: &Segment) -> Capsule {
    Capsule { a: segment.a, b: segment.b, radius: 0.0 }
}

/// Calls `f` with the polyhedral core of a shape, if it has one.
#[inline(always)]
fn with_view<R>(shape: &Shape, f: impl FnOnce(Option<&View>) -> R) -> R {
    let small = match shape {
        Shape::Hull(hull) => return f(Some(&View::from(&**hull))),
        Shape::Cuboid(s) => Small::cuboid(s.half),
        Shape::Triangle(s) => Small::triangle([s.a, s.b, s.c]),
        Shape::Capsule(s) => Small::capsule(s),
        Shape::Segment(s) => Small::segment(s.a, s.b, 0.0),
        Shape::Ball(s) => Small::point(Vector::ZERO, s.radius),
        Shape::Composite(_) | Shape::Curved(_) | Shape::HalfSpace(_) | Shape::Foreign(_) => return f(None),
    };
    f(Some(&small.view()))
}
