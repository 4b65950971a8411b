//! The point where the rim of a rocking disc will touch.
//!
//! A disc that leans by a small angle α stands on one point of its rim, which runs along the rim much faster
//! than the disc rocks: by 1/α times the angle. Solver rows keep the arms of a contact for a step, and an arm
//! that lags behind feeds the rocking: a heap of coins rocked for ever. So the point is placed where it will
//! be in the middle of the step.

use super::shape_features::across;
use crate::manifold::LocalManifold;
use crate::math::{Angular, Pose, Rot, Vector, min};
use crate::shape::{Curved, Shape};
use crate::tuning::contact::MOST_WAY;
use crate::tuning::manifold::{ALIKE, ROLLING};
use crate::tuning::sweeps::LAG;

/// Moves points at the lowest point of a rim, up to `near` apart, to the lowest point after B has turned by
/// `turn` relative to A, a rotation vector in world axes. `out` is the contact of the shapes, `rotation_a`
/// A's rotation in the world, `pose_b_in_a` B's pose in A's frame.
///
/// Returns how far the surfaces may move against each other, in metres, until the points lag behind; infinity
/// if no point is moved.
pub fn midstep_rims(
    shapes: [&Shape; 2],
    rotation_a: Rot,
    pose_b_in_a: &Pose,
    turn: Angular,
    near: f32,
    out: &mut LocalManifold,
) -> f32 {
    let turn = rotation_a.inverse_rotate(turn);
    let mut allowed = f32::INFINITY;
    if let Shape::Curved(a) = shapes[0] {
        let rim = Rim::new(a, out.normal, -turn);
        allowed = min(allowed, rim.shift_points(out, near, |point| point, |shift| shift));
    }
    if let Shape::Curved(b) = shapes[1] {
        let rotation = pose_b_in_a.rotation;
        let rim = Rim::new(b, rotation.inverse_rotate(-out.normal), rotation.inverse_rotate(turn));
        let to_b = |point| pose_b_in_a.inverse_transform(point);
        allowed = min(allowed, rim.shift_points(out, near, to_b, |shift| rotation.rotate(shift)));
    }
    allowed
}

/// The rim on which a shape stands, in the shape's frame.
struct Rim {
    /// The lowest point.
    lowest: Vector,
    /// The shift of the lowest point in half a step.
    shift: Vector,
    /// The present height of the shifted point above the lowest point.
    rise: f32,
    /// The radius, or 0 if the shape does not lean on its rim.
    radius: f32,
    /// The sine of the angle by which the shape leans.
    lean: f32,
}

impl Rim {
    /// `down` is the unit normal out of the shape, `turn` the rotation vector of the shape.
    fn new(shape: &Curved, down: Vector, turn: Vector) -> Self {
        // Seen from the shape, the other surface turns the other way.
        let ((lean, around), (lean_then, around_then)) = (across(down), across(down + down.cross(turn)));
        let end = shape.end_along(lean, down.y);
        let leans = lean > ALIKE && lean < ROLLING;
        let radius = if leans { shape.radius_of(end) } else { 0.0 };
        let lowest = around * radius + Vector::Y * shape.height_of(end);
        let run = around_then - around;
        let runs = lean_then > ALIKE && run.length_squared() < MOST_WAY * MOST_WAY;
        let shift = if runs { run * radius } else { Vector::ZERO };
        Self { lowest, shift, rise: -shift.dot(down), radius, lean }
    }

    fn shift_points(
        &self,
        out: &mut LocalManifold,
        near: f32,
        to_shape: impl Fn(Vector) -> Vector,
        from_shape: impl Fn(Vector) -> Vector,
    ) -> f32 {
        let is_full = out.count == out.points.len();
        let mut allowed = f32::INFINITY;
        for p in out.points_mut() {
            if p.separation <= near && (to_shape(p.point) - self.lowest).length() < LAG * self.radius {
                p.point += from_shape(self.shift);
                p.separation += self.rise;
                if !is_full {
                    allowed = LAG * self.lean * self.radius;
                }
            }
        }
        allowed
    }
}
