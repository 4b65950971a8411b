//! What joints keep between steps, beside their definitions.

use super::dim::{AXES, BLOCK, TURNS};
use crate::math::{Angular, Vector};

/// What a joint did to body B in the last substep, and against which it pushed A.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointReaction {
    /// In world axes, in N.
    pub force: Vector,
    /// About B's anchor, in world axes, in N·m.
    pub torque: Angular,
    /// Forces in N, or torques in N·m, of the motors, by number of the coordinate.
    pub motors: [f32; AXES],
    /// Torque of the orientation motor on B, in world axes, in N·m. It is part of `torque`.
    pub orientation: Angular,
}

/// What a joint keeps between steps, beside its definition.
///
/// Fields that all joints use come first. Only joints with limits, springs or motors touch the cache lines after them.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct State {
    /// Impulses of what is locked in A's frame, N·s or N·m·s, by number of the coordinate.
    pub(super) block: [f32; BLOCK],
    pub(super) reaction: JointReaction,
    /// The angle that counts turns, at the end of the last step. NaN before the first.
    pub(super) angle: f32,
    /// Impulses of lower limit, upper limit, spring and motor, by number of the coordinate.
    pub(super) singles: [[f32; 4]; AXES],
    /// Impulses of the orientation motor along A's axes, N·m·s.
    pub(super) orientation: [f32; TURNS],
}

impl State {
    pub(super) fn new() -> Self {
        let (block, singles, orientation) = ([0.0; BLOCK], [[0.0; 4]; AXES], [0.0; TURNS]);
        let (angle, reaction) = (f32::NAN, JointReaction::default());
        Self { block, singles, orientation, angle, reaction }
    }
}
