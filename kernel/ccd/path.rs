//! The motion of a body over a step: a straight line at constant speed, and a rotation at a constant rate.

use crate::math::{Angular, Rot, Vector, WorldPose};
use crate::table::BodyPose;

/// The motion of a body over a step.
#[derive(Clone, Copy, Debug)]
pub struct Path {
    /// The pose of the body at the start of the step.
    pub start: BodyPose,
    /// The centre of mass in the body's frame.
    pub local_center: Vector,
    /// The displacement of the centre of mass over the step, in metres.
    pub way: Vector,
    /// The rotation over the step, as an axis times an angle in radians.
    pub spin: Angular,
}

impl Path {
    /// The path of a body from `start` by a displacement and a rotation. `turn` does not contain whole turns:
    /// `spin`, the approximate rotation by the angular velocity, gives their number.
    pub fn new(start: BodyPose, local_center: Vector, way: Vector, turn: Rot, spin: Angular) -> Self {
        Self { start, local_center, way, spin: turn.angle_near(spin) }
    }

    /// A body that stays where it is.
    pub fn still(start: BodyPose, local_center: Vector) -> Self {
        Self { start, local_center, way: Vector::ZERO, spin: Angular::ZERO }
    }

    /// The path, without its rotation unless `turns`.
    pub(super) fn turning_if(mut self, turns: bool) -> Self {
        if !turns {
            self.spin = Angular::ZERO;
        }
        self
    }

    /// The body's frame after a fraction of the step.
    pub fn frame(&self, fraction: f32) -> WorldPose {
        let (way, turn) = self.delta(fraction);
        let mut pose = self.start;
        pose.center += way.to_world();
        pose.rotation = turn.mul(pose.rotation).renormalized();
        pose.frame(self.local_center)
    }

    /// The displacement and rotation of the body after a fraction of the step.
    pub fn delta(&self, fraction: f32) -> (Vector, Rot) {
        (self.way * fraction, Rot::IDENTITY.turned_by(self.spin * fraction))
    }
}
