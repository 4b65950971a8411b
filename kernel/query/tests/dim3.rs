//! Shapes in space only.

use crate::math::Vector;
use crate::shape::{Hull, Shape};
use std::sync::Arc;

/// The convex hull of some points, if they span one.
pub(super) fn hull(points: &[Vector], _radius: f32) -> Option<Shape> {
    Hull::convex_hull_of(points).ok().map(|hull| Shape::Hull(Arc::new(hull)))
}
