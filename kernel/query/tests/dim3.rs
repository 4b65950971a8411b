//! Shapes in space only.

use crate::math::Vector;
use crate::shape::{Curved, Hull, Shape};
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
