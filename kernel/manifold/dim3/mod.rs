//! Contact manifolds in space. `dim2` has the same functions for the plane.
//!
//! This file chooses the function of each pair, and has the function of half-spaces. Balls and capsules have
//! closed forms where they exist ([`round`]), two boxes have a function of their own ([`cuboids`]), and all
//! other pairs of polyhedra (with radii) share [`convex`]. Shapes that are round about an axis are in
//! [`curved`].

mod axis;
mod clip;
mod convex;
mod cuboids;
mod curved;
mod facet;
mod gjk;
#[cfg(test)]
mod near_tests;
#[cfg(test)]
mod oracle;
mod round;
#[cfg(test)]
mod tests;
#[cfg(test)]
pub(super) mod tests_pairs;
#[cfg(test)]
mod tests_triangle;
mod view;

use super::{LocalManifold, LocalPoint, PairInput};
use crate::math::{Vector, min};
use crate::shape::{Capsule, Segment, Shape};
use clip::{Candidates, MAX_CANDIDATES, keep};
pub(super) use cuboids::collide as collide_cuboids;
pub use curved::midstep_rims;
pub(super) use facet::{Convex, borders, face_normal, facing, few_points, with_convex};
use view::with_view;

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

/// The feature of a point of the swapped pair: it does not depend on the order.
pub(super) fn swapped_feature(feature: u32) -> u32 {
    feature
}

/// The function of each pair, all by name: a new shape does not compile until its pairs are here.
pub(super) fn dispatch(a: &Shape, b: &Shape, input: PairInput, out: &mut LocalManifold) {
    use Shape::{Ball, Capsule, Composite, Cuboid, Curved, Foreign, HalfSpace, Hull, Segment, Triangle};
    match (a, b) {
        (HalfSpace(a), Curved(b)) => curved::half_space(a.normal, b, input, out),
        (HalfSpace(a), b) => half_space(a.normal, b, input, out),
        (Ball(a), Ball(b)) => round::balls(a, b, input, out),
        (Cuboid(a), Ball(b)) => round::cuboid_ball(a, b, input, out),
        (Triangle(a), Ball(b)) => round::triangle_ball(a, b, input, out),
        (Capsule(a), Ball(b)) => round::capsule_ball(a, b, input, out),
        (Segment(a), Ball(b)) => round::capsule_ball(&capsule(a), b, input, out),
        (Curved(a), Ball(b)) => curved::ball(a, b, input, out),
        (Capsule(a), Capsule(b)) => round::capsules(a, b, input, out),
        (Capsule(a), Segment(b)) => round::capsules(a, &capsule(b), input, out),
        (Segment(a), Capsule(b)) => round::capsules(&capsule(a), b, input, out),
        (Segment(a), Segment(b)) => round::capsules(&capsule(a), &capsule(b), input, out),
        (Curved(a), Curved(b)) => curved::frusta(a, b, input, out),
        (Cuboid(_) | Hull(_) | Triangle(_) | Capsule(_) | Segment(_), Curved(b)) => {
            curved::with_polyhedron(a, b, input, out);
        }
        (Hull(_), Ball(_))
        | (Cuboid(_) | Hull(_) | Triangle(_), Cuboid(_) | Hull(_) | Triangle(_) | Capsule(_) | Segment(_)) => {
            polyhedra(a, b, input, out);
        }
        // Composites are collided part by part, and foreign shapes by their `ManifoldSource`.
        (_, Composite(_) | Foreign(_)) => {}
        // `collide` swaps these pairs, or handles them itself.
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

/// Two shapes with polyhedral cores. Not inlined, since its stack frame is large.
#[inline(never)]
fn polyhedra(a: &Shape, b: &Shape, input: PairInput, out: &mut LocalManifold) {
    with_view(a, |a| {
        with_view(b, |b| {
            if let (Some(a), Some(b)) = (a, b) {
                convex::collide(a, b, input, out);
            }
        });
    });
}

/// A segment as a capsule without radius.
fn capsule(segment: &Segment) -> Capsule {
    Capsule { a: segment.a, b: segment.b, radius: 0.0 }
}

/// The vertices of a shape over a half-space: the contact of the half-space with the given unit normal, in
/// its own frame, with a shape.
fn half_space(normal: Vector, b: &Shape, input: PairInput, out: &mut LocalManifold) {
    match b {
        Shape::Ball(s) => half_space_vertices(normal, [Vector::ZERO], s.radius, input, out),
        Shape::Capsule(s) => half_space_vertices(normal, [s.a, s.b], s.radius, input, out),
        Shape::Segment(s) => half_space_vertices(normal, [s.a, s.b], 0.0, input, out),
        Shape::Triangle(s) => half_space_vertices(normal, [s.a, s.b, s.c], 0.0, input, out),
        Shape::Cuboid(s) => {
            let side = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
            let corner = |i: usize| Vector { x: side(i & 1), y: side(i & 2), z: side(i & 4) }.scale(s.half);
            half_space_vertices(normal, (0..8).map(corner), 0.0, input, out);
        }
        Shape::Hull(s) => half_space_vertices(normal, s.vertices().iter().copied(), s.radius(), input, out),
        Shape::Composite(_) | Shape::Curved(_) | Shape::HalfSpace(_) | Shape::Foreign(_) => {}
    }
}

fn half_space_vertices(
    normal: Vector,
    points: impl IntoIterator<Item = Vector>,
    radius: f32,
    PairInput { pose, prediction, .. }: PairInput,
    out: &mut LocalManifold,
) {
    // Heights are computed in the frame of B: one product per vertex, and only near vertices are transformed.
    let (local, base) = (pose.rotation.inverse_rotate(normal), normal.dot(pose.position) - radius);
    let mut candidates = Candidates::<MAX_CANDIDATES>::new();
    out.gap = f32::INFINITY;
    for (i, p) in points.into_iter().enumerate() {
        let separation = local.dot(p) + base;
        out.gap = min(out.gap, separation);
        if separation <= prediction {
            let point = pose.transform(p) - normal * (radius + 0.5 * separation);
            candidates.push(LocalPoint::new(point, separation, i as u32));
        }
    }
    out.normal = normal;
    keep::<false>(candidates.as_slice(), out);
}
