//! What of a tree of joints is kept between its passes.

use super::super::batch::Pass;
use super::dim::DOF;
use super::place::Gradient;
use super::single::Single;

/// What of a tree holds from pass to pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Known {
    /// Its bodies have moved.
    #[default]
    Nothing,
    /// Where its joints are.
    Places,
    /// The factors of a pass as well. Both solve passes of a substep use the same.
    Factors(Pass),
}

/// Buffers for the passes of a tree.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    pub(super) known: Known,
    /// Whether the masses that coordinates move are known in this step.
    pub(super) is_weighed: bool,
    /// By body, its velocity.
    pub(super) velocities: Vec<[f32; DOF]>,
    /// By single coordinate.
    pub(super) coordinates: Vec<Coordinate>,
    /// Joints whose coordinates are let go or held, those coordinates, and by how much their impulses change.
    pub(super) changes: Vec<(usize, usize, f32)>,
}

/// A single coordinate in a pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinate {
    pub(super) gradient: Gradient<f32>,
    pub(super) value: f32,
    /// What a unit impulse changes, as the two bodies alone allow.
    pub(super) alone: f32,
    /// The same as all that is locked in the tree allows, at the start of the step. 0 if it allows nothing.
    pub(super) left: f32,
    /// The limit that acts, if one does: 0 for the lower one, 1 for the upper one.
    pub(super) limit: Option<usize>,
    /// Whether the motor is at its maximum.
    pub(super) is_capped: bool,
    /// Its row of the link, if anything acts.
    pub(super) row: Option<usize>,
}

impl Coordinate {
    pub(super) const NONE: Self = Self {
        gradient: Gradient::NONE,
        value: 0.0,
        alone: 0.0,
        left: 0.0,
        limit: None,
        is_capped: false,
        row: None,
    };

    /// At the start of a step: what acted at the end of the last one acts again.
    pub(super) fn new(single: &Single<f32>) -> Self {
        let most = single.motor.most;
        Self {
            limit: single.limit(),
            is_capped: most > 0.0 && single.motor.impulse.abs() >= most,
            ..Self::NONE
        }
    }
}

impl Scratch {
    /// Forgets what was found out: bodies have moved, or are others.
    pub(super) fn forget(&mut self) {
        self.known = Known::Nothing;
    }
}
