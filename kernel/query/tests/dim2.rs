//! Shapes in the plane only.

use crate::math::Vector;
use crate::shape::{Hull, Shape};
use std::sync::Arc;

/// The convex hull of some points with a radius, if they span one.
pub(super) fn hull(points: &[Vector], radius: f32) -> Option<Shape> {
    Hull::convex_hull_of(points, radius).ok().map(|hull| Shape::Hull(Arc::new(hull)))
}
