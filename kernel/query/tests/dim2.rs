//! Shapes in the plane only.

use crate::math::Vector;
use crate::shape::{Curved, Facet, Hull, Shape, Surface};
use proptest::prelude::*;
use std::sync::Arc;

/// The convex hull of some points with a radius, if they span one.
pub(super) fn hull(points: &[Vector], radius: f32) -> Option<Shape> {
    Hull::convex_hull_of(points, radius).ok().map(|hull| Shape::Hull(Arc::new(hull)))
}

/// Ellipses.
pub(super) fn curved() -> impl Strategy<Value = Shape> {
    (0.05f32..1.0, 0.05f32..1.0).prop_map(|(x, y)| Shape::Curved(Curved { half: Vector { x, y } }))
}

/// The ends of a facet.
pub(super) fn corners(facet: &Facet) -> [Vector; 2] {
    [facet.a, facet.b]
}

/// A closed outline around the origin, at distances from 0.5 to 1 times its size, and that size.
pub(super) fn star() -> impl Strategy<Value = (Shape, f32)> {
    (prop::collection::vec(0.5f32..1.0, 5..40), prop_oneof![Just(0.02f32), Just(1.0), Just(1000.0)]).prop_map(
        |(radii, size)| {
            let count = radii.len() as u32;
            let vertices = radii.iter().enumerate().map(|(i, radius)| {
                let angle = core::f32::consts::TAU * i as f32 / count as f32;
                Vector { x: angle.cos(), y: angle.sin() } * (radius * size)
            });
            let facets = (0..count).map(|i| [i, (i + 1) % count]).collect();
            (Shape::surface(Surface::new(vertices.collect(), facets).expect("an outline")), size)
        },
    )
}

/// A line of segments along x, and half its length.
pub(super) fn lattice() -> impl Strategy<Value = (Shape, f32)> {
    let sizes = prop_oneof![Just(0.01f32), Just(1.0), Just(1000.0)];
    (prop::collection::vec(-0.3f32..0.3, 1..20), sizes).prop_map(|(shifts, size)| {
        let count = shifts.len() as u32;
        let inner = shifts.iter().enumerate().map(|(i, shift)| (1.0 + i as f32 + shift) / (count + 1) as f32);
        let along = core::iter::once(0.0).chain(inner).chain([1.0]);
        let vertices = along.map(|t| Vector { x: (2.0 * t - 1.0) * size, y: 0.0 }).collect();
        let facets = (0..=count).map(|i| [i, i + 1]).collect();
        (Shape::surface(Surface::new(vertices, facets).expect("a line")), size)
    })
}
