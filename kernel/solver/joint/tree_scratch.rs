//! Data of trees of joints that is kept between passes.

use super::super::batch::SolverPass;
use super::dim::DOF;
use super::place::Gradient;
use super::single::Single;
use crate::math::Lane;

/// The data of a tree that is still valid from earlier passes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Known {
    /// Nothing, because its bodies have moved.
    #[default]
    Nothing,
    /// The positions of its joints.
    Places,
    /// Positions, and the factors of a pass. Both solve passes of a substep use the same factors.
    Factors(SolverPass),
}

/// Buffers for the passes of a group of trees.
#[derive(Clone, Debug)]
pub(super) struct Scratch<N: Lane> {
    pub(super) known: Known,
    /// 1 in lanes for which repeating the pass would give the same result, otherwise 0. These lanes have no
    /// orientation motor, and the last pass found all active rows.
    pub(super) settled: N,
    /// Whether the masses that coordinates move are known in this step.
    pub(super) is_weighed: bool,
    /// 1 in lanes that still have to be solved, otherwise 0.
    pub(super) open: N,
    /// The value of `open` before the last pivoting.
    pub(super) was_open: N,
    /// 1 in lanes whose orientation motors are solved, otherwise 0.
    pub(super) driven: N,
    /// 1 in lanes whose orientation motors are solved next, otherwise 0.
    pub(super) due: N,
    /// Whether limits may be activated in this round.
    pub(super) adds: bool,
    /// Whether this is the last round.
    pub(super) is_last: bool,
    /// The velocity of each body.
    pub(super) velocities: Vec<[N; DOF]>,
    /// The state of each single coordinate.
    pub(super) coordinates: Vec<Coordinate<N>>,
    /// Joints with coordinates that were released or capped, these coordinates, and the changes of their
    /// impulses.
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
    /// The inverse effective mass, with the two bodies alone.
    pub(super) alone: N,
    /// The inverse effective mass with all locked coordinates of the tree, at the start of the step. 0 if
    /// they allow no motion.
    pub(super) left: N,
    /// 1 for the active limit, the lower or the upper one, otherwise 0.
    pub(super) held: [N; 2],
    /// 1 if the motor is at its maximum, otherwise 0.
    pub(super) is_capped: N,
    /// 1 if a limit, spring or motor is active, otherwise 0.
    pub(super) acts: N,
    /// Whether its laws depend on the mass that the coordinate moves.
    pub(super) is_per_mass: bool,
    /// Its row of the link, if it is active in any lane.
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

    /// The state at the start of a step: limits and motors that were active at the end of the last step are
    /// active again.
    #[inline(always)]
    pub(super) fn new(single: &Single<N>) -> Self {
        let is_per_mass = single.is_per_mass();
        Self { held: single.held(), is_capped: single.is_capped(), is_per_mass, ..Self::NONE }
    }
}

impl<N: Lane> Scratch<N> {
    /// Marks all data as outdated, because bodies have moved or changed.
    pub(super) fn forget(&mut self) {
        self.known = Known::Nothing;
    }
}
