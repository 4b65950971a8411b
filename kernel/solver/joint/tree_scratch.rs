//! What of a tree of joints is kept between its passes.

use super::super::batch::Pass;
use super::dim::DOF;
use super::place::Gradient;
use super::single::Single;
use crate::math::Lane;

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

/// Buffers for the passes of trees side by side.
#[derive(Clone, Debug)]
pub(super) struct Scratch<N: Lane> {
    pub(super) known: Known,
    /// 1 in lanes that would come to the same again, else 0: the last pass found what acts, and no orientation motor is in turn.
    pub(super) settled: N,
    /// Whether the masses that coordinates move are known in this step.
    pub(super) is_weighed: bool,
    /// 1 in lanes that are solved, and not done yet, else 0.
    pub(super) open: N,
    /// The same before the last pivots.
    pub(super) was_open: N,
    /// 1 in lanes whose orientation motors were solved, else 0.
    pub(super) driven: N,
    /// 1 in lanes whose orientation motors are solved next, else 0.
    pub(super) due: N,
    /// Whether limits may be added in this round.
    pub(super) adds: bool,
    /// Whether it is the last round.
    pub(super) is_last: bool,
    /// By body, its velocity.
    pub(super) velocities: Vec<[N; DOF]>,
    /// By single coordinate.
    pub(super) coordinates: Vec<Coordinate<N>>,
    /// Joints whose coordinates are let go or held, those coordinates, and by how much their impulses change.
    pub(super) changes: Vec<(usize, usize, N)>,
}

impl<N: Lane> Default for Scratch<N> {
    fn default() -> Self {
        Self {
            known: Known::Nothing,
            settled: N::ZERO,
            is_weighed: false,
            open: N::ONE,
            was_open: N::ONE,
            driven: N::ONE,
            due: N::ZERO,
            adds: false,
            is_last: false,
            velocities: Vec::new(),
            coordinates: Vec::new(),
            changes: Vec::new(),
        }
    }
}

/// A single coordinate in a pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinate<N> {
    pub(super) gradient: Gradient<N>,
    pub(super) value: N,
    /// What a unit impulse changes, as the two bodies alone allow.
    pub(super) alone: N,
    /// The same as all that is locked in the tree allows, at the start of the step. 0 if it allows nothing.
    pub(super) left: N,
    /// 1 for the limit that acts, the lower or the upper one, else 0.
    pub(super) held: [N; 2],
    /// 1 if the motor is at its maximum, else 0.
    pub(super) is_capped: N,
    /// 1 if anything acts, else 0.
    pub(super) acts: N,
    /// Whether its laws depend on the mass that it moves.
    pub(super) is_per_mass: bool,
    /// Its row of the link, if anything acts in any lane.
    pub(super) row: Option<usize>,
}

impl<N: Lane> Coordinate<N> {
    pub(super) const NONE: Self = Self {
        gradient: Gradient::NONE,
        value: N::ZERO,
        alone: N::ZERO,
        left: N::ZERO,
        held: [N::ZERO; 2],
        is_capped: N::ZERO,
        acts: N::ZERO,
        is_per_mass: false,
        row: None,
    };

    /// At the start of a step: what acted at the end of the last one acts again.
    #[inline(always)]
    pub(super) fn new(single: &Single<N>) -> Self {
        let is_per_mass = single.is_per_mass();
        Self { held: single.held(), is_capped: single.is_capped(), is_per_mass, ..Self::NONE }
    }
}

impl<N: Lane> Scratch<N> {
    /// Forgets what was found out: bodies have moved, or are others.
    pub(super) fn forget(&mut self) {
        self.known = Known::Nothing;
    }
}
