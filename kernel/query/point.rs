//! The point of a shape that is nearest to a point.

use super::closest::{Closest, closest, overlaps};
use crate::math::{Pose, Rot, Vector};
use crate::shape::{Ball, Shape};

/// A point projected onto a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// The nearest point of the shape, in the shape's frame.
    pub point: Vector,
    /// Whether the given point is inside. Surfaces have no inside.
    pub is_inside: bool,
    /// The distance between both points, in metres.
    pub distance: f32,
}

const POINT: Shape = Shape::Ball(Ball { radius: 0.0 });

/// The nearest point of a shape to a point in its frame. A point inside is its own projection if `solid`,
/// otherwise it is projected onto the boundary; in a compound, onto the boundary of the part in which it is
/// deepest.
///
/// `None` if the projection is farther than `limit` metres, if a number is not finite, and for foreign
/// shapes.
pub fn project_point(shape: &Shape, point: Vector, solid: bool, limit: f32) -> Option<Projection> {
    if !point.is_finite() || !(limit >= 0.0) {
        return None;
    }
    let at = Pose::new(point, Rot::IDENTITY);
    if solid && contains_point(shape, point) {
        return Some(Projection { point, is_inside: has_inside(shape), distance: 0.0 });
    }
    let Closest { points, distance, .. } = closest(shape, &POINT, &at, limit)?;
    let is_inside = distance <= 0.0 && has_inside(shape);
    let distance = distance.abs();
    (distance <= limit).then_some(Projection { point: points[0], is_inside, distance })
}

/// Whether a point in the shape's frame is in the shape, the boundary included.
pub fn contains_point(shape: &Shape, point: Vector) -> bool {
    point.is_finite() && overlaps(shape, &POINT, &Pose::new(point, Rot::IDENTITY))
}

/// Whether points can be inside the shape.
fn has_inside(shape: &Shape) -> bool {
    match shape {
        Shape::Composite(composite) => composite.surface().is_none(),
        Shape::HalfSpace(_) => true,
        shape => shape.core().1 > 0.0,
    }
}
