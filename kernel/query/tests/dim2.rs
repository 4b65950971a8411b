//! Shapes in the plane only.

use crate::math::Vector;
use crate::shape::{Curved, Hull, Shape};
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
