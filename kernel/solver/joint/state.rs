//! State of joints between steps, other than their definitions.

use super::dim::{AXES, BLOCK, TURNS};
use crate::math::{Angular, Vector};

/// Force and torque of a joint on body B in the last substep. A receives the opposite force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointReaction {
    /// Force in world axes, N.
    pub force: Vector,
    /// Torque about B's anchor, in world axes, N·m.
    pub torque: Angular,
    /// Forces in N, or torques in N·m, of the motors, by coordinate number.
    pub motors: [f32; AXES],
    /// Torque of the orientation motor on B, in world axes, N·m. It is part of `torque`.
    pub orientation: Angular,
}

/// State of a joint between steps, other than its definition.
///
/// Fields that all joints use come first. Only joints with limits, springs or motors touch the later cache
/// lines.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct State {
    /// Impulses of the coordinates locked in A's frame, N·s or N·m·s, by coordinate number.
    pub(super) block: [f32; BLOCK],
    pub(super) reaction: JointReaction,
    /// The turning angle, counted over whole turns, at the end of the last step. NaN before the first step.
    pub(super) angle: f32,
    /// Impulses of lower limit, upper limit, spring and motor, by coordinate number.
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
