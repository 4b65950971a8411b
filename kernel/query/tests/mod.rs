//! Queries against certificates and brute force, over random shapes and poses.
//!
//! A distance is certified from both sides: points of both shapes at that distance, and a plane with that gap
//! between the shapes' support points. No other implementation of a distance is needed.

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod many;
mod pairs;
mod rays;
mod world;

use crate::math::{DIM, Pose, Rot, Vector};
use crate::shape::{Ball, Capsule, Cuboid, HalfSpace, Part, Segment, Shape, Surface, Triangle};
use proptest::prelude::*;

pub(crate) fn vector(range: f32) -> impl Strategy<Value = Vector> {
    prop::array::uniform3(-range..range).prop_map(|v| Vector::from_array(core::array::from_fn(|i| v[i])))
}

fn unit() -> impl Strategy<Value = Vector> {
    vector(1.0).prop_filter_map("too short", |v| (v.length() > 0.05).then(|| v * (1.0 / v.length())))
}

fn turn() -> impl Strategy<Value = Rot> {
    prop::array::uniform3(-3.0..3.0f32).prop_map(|a| {
        let step = |rot: Rot, i: usize| {
            let mut delta = crate::math::Angular::ZERO;
            delta.z = a[i];
            let quarter = Vector::AXES[i % DIM] * (0.3 * a[(i + 1) % 3]);
            rot.turned_by(delta).turned_by(quarter.cross(Vector::AXES[(i + 1) % DIM]))
        };
        (0..3).fold(Rot::IDENTITY, step)
    })
}

pub(crate) fn pose(range: f32) -> impl Strategy<Value = Pose> {
    (vector(range), turn()).prop_map(|(position, rotation)| Pose { position, rotation })
}

/// Bounded convex shapes, some of them flat, small or rounded.
pub(crate) fn convex() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (0.0f32..1.0).prop_map(|radius| Shape::Ball(Ball { radius })),
        (vector(1.0), vector(1.0), 0.0f32..0.5).prop_map(|(a, b, radius)| Shape::Capsule(Capsule {
            a,
            b,
            radius
        })),
        vector(1.0).prop_map(|half| Shape::Cuboid(Cuboid { half: half.abs() })),
        vector(0.02).prop_map(|half| Shape::Cuboid(Cuboid { half: half.abs() })),
        (prop::collection::vec(vector(1.0), 4..24), prop_oneof![Just(0.0), 0.0f32..0.5])
            .prop_filter_map("no hull", |(points, radius)| dim::hull(&points, radius)),
        [vector(1.0), vector(1.0), vector(1.0)].prop_map(|[a, b, c]| Shape::Triangle(Triangle { a, b, c })),
        [vector(1.0), vector(1.0)].prop_map(|[a, b]| Shape::Segment(Segment { a, b })),
        dim::curved(),
    ]
}

fn half_space() -> impl Strategy<Value = Shape> {
    unit().prop_map(|normal| Shape::HalfSpace(HalfSpace { normal }))
}

fn composite() -> impl Strategy<Value = Shape> {
    let surface = prop::collection::vec((vector(3.0), prop::array::uniform3(vector(0.7))), 1..40)
        .prop_filter_map("no surface", |facets| {
            let corners = facets.iter().flat_map(|(at, sides)| sides[..DIM].iter().map(|side| *at + *side));
            let vertices: Vec<Vector> = corners.collect();
            let facets =
                (0..facets.len() as u32).map(|i| core::array::from_fn(|k| DIM as u32 * i + k as u32));
            Some(Shape::surface(Surface::new(vertices, facets.collect()).ok()?))
        });
    let compound = prop::collection::vec((pose(2.0), convex()), 1..12)
        .prop_filter_map("no compound", |solids| Shape::compound(solids).ok());
    prop_oneof![surface, compound]
}

fn any_shape() -> impl Strategy<Value = Shape> {
    prop_oneof![5 => convex(), 1 => half_space(), 2 => composite()]
}

/// The convex parts of a shape in its frame.
fn parts(shape: &Shape) -> Vec<(Pose, Shape)> {
    let Shape::Composite(composite) = shape else { return vec![(Pose::IDENTITY, shape.clone())] };
    let part = |i: u32| match composite.part(i) {
        Part::Facet(facet) => (Pose::IDENTITY, Shape::from(facet)),
        Part::Solid(pose, solid) => (*pose, solid.clone()),
    };
    (0..composite.len() as u32).map(part).collect()
}
