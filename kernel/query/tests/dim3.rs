//! Shapes in space only.

use crate::math::Vector;
use crate::shape::{Curved, Facet, Hull, Shape, Surface};
use proptest::prelude::*;
use std::sync::Arc;

/// The convex hull of some points with a radius, if they span one.
pub(super) fn hull(points: &[Vector], radius: f32) -> Option<Shape> {
    let hull = Hull::convex_hull_of(points).ok()?.rounded(radius).ok()?;
    Some(Shape::Hull(Arc::new(hull)))
}

/// Cylinders, cones and frusta.
pub(super) fn curved() -> impl Strategy<Value = Shape> {
    (0.05f32..1.0, 0.0f32..1.0, 0.05f32..1.0).prop_map(|(lower, upper, half_height)| {
        let upper = if upper < 0.2 {
            0.0
        } else if upper > 0.8 {
            lower
        } else {
            upper
        };
        Shape::Curved(Curved { lower, upper, half_height })
    })
}

/// The corners of a facet.
pub(super) fn corners(facet: &Facet) -> [Vector; 3] {
    [facet.a, facet.b, facet.c]
}

/// A closed surface around the origin, at distances from 0.5 to 1 times its size, and that size.
pub(super) fn star() -> impl Strategy<Value = (Shape, f32)> {
    const AROUND: u32 = 7;
    const RINGS: u32 = 5;
    let radii = prop::collection::vec(0.5f32..1.0, (AROUND * RINGS + 2) as usize);
    (radii, prop_oneof![Just(0.02f32), Just(1.0), Just(1000.0)]).prop_map(|(radii, size)| {
        let ring = |row: u32, i: u32| {
            let (polar, angle) = (
                core::f32::consts::PI * (row + 1) as f32 / (RINGS + 1) as f32,
                core::f32::consts::TAU * i as f32 / AROUND as f32,
            );
            Vector { x: polar.sin() * angle.cos(), y: polar.cos(), z: polar.sin() * angle.sin() }
        };
        let rings = (0..RINGS).flat_map(|row| (0..AROUND).map(move |i| ring(row, i)));
        let directions = rings.chain([Vector::Y, -Vector::Y]);
        let vertices = directions.zip(&radii).map(|(v, radius)| v * (radius * size)).collect();
        let number = |row: u32, i: u32| row * AROUND + i % AROUND;
        let (top, bottom) = (RINGS * AROUND, RINGS * AROUND + 1);
        let mut facets: Vec<[u32; 3]> = Vec::new();
        for i in 0..AROUND {
            facets.push([top, number(0, i + 1), number(0, i)]);
            facets.push([bottom, number(RINGS - 1, i), number(RINGS - 1, i + 1)]);
            for row in 0..RINGS - 1 {
                let [a, b] = [number(row, i), number(row, i + 1)];
                let [c, d] = [number(row + 1, i), number(row + 1, i + 1)];
                facets.extend([[a, b, c], [b, d, c]]);
            }
        }
        (Shape::surface(Surface::new(vertices, facets).expect("a surface")), size)
    })
}

/// A square of triangles across y, and half its width.
pub(super) fn lattice() -> impl Strategy<Value = (Shape, f32)> {
    let sizes = prop_oneof![Just(0.01f32), Just(1.0), Just(1000.0)];
    (1..5u32, prop::collection::vec(-0.3f32..0.3, 72), sizes, prop_oneof![Just(0.0f32), Just(1.0)]).prop_map(
        |(inner, shifts, size, shifted)| {
            let cells = inner + 1;
            let along = |i: u32, shift: f32| {
                let is_border = i == 0 || i == cells;
                let shift = if is_border { 0.0 } else { shift * shifted };
                (2.0 * (i as f32 + shift) / cells as f32 - 1.0) * size
            };
            let number = |i: u32, j: u32| i * (cells + 1) + j;
            let vertices = (0..=cells).flat_map(|i| (0..=cells).map(move |j| (i, j))).map(|(i, j)| {
                let k = 2 * number(i, j) as usize;
                Vector { x: along(i, shifts[k]), y: 0.0, z: along(j, shifts[k + 1]) }
            });
            let facets = (0..cells).flat_map(|i| {
                (0..cells).flat_map(move |j| {
                    let [a, b, c, d] =
                        [number(i, j), number(i, j + 1), number(i + 1, j), number(i + 1, j + 1)];
                    [[a, b, c], [b, d, c]]
                })
            });
            (Shape::surface(Surface::new(vertices.collect(), facets.collect()).expect("a wall")), size)
        },
    )
}
