//! What of a tree of joints is kept between its passes.

use super::super::batch::Pass;
use super::dim::{BLOCK, DOF};
use super::place::{Gradient, Response};

/// What of a tree holds from pass to pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Known {
    /// Its bodies have moved.
    #[default]
    Nothing,
    /// Where its joints are.
    Places,
    /// The factors and responses of a pass as well. Both solve passes of a substep use the same.
    Factors(Pass),
}

/// Buffers for the passes of a tree.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    pub(super) known: Known,
    /// By body, its velocity.
    pub(super) velocities: Vec<[f32; DOF]>,
    /// By single coordinate with a response, and body: what a unit impulse changes.
    pub(super) unit_velocities: Vec<[f32; DOF]>,
    /// By single coordinate with a response, and joint: the impulses of what is locked that answer it.
    pub(super) unit_impulses: Vec<[f32; BLOCK]>,
    /// By single coordinate.
    pub(super) coordinates: Vec<Coordinate>,
}

/// Maximum number of bodies, over all responses of a tree that are kept: what fits into a core's cache. Where there are more, all
/// are found anew.
pub(super) const MOST_KEPT: usize = 1 << 13;

/// In place of a number among coordinates with a response.
pub(super) const NOT_YET: usize = usize::MAX;

/// A single coordinate in a pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinate {
    pub(super) gradient: Gradient<f32>,
    pub(super) value: f32,
    /// Its number among those with a response.
    pub(super) number: usize,
    /// The changes of velocity of its own bodies by a unit impulse: as what is locked allows, and of these bodies alone.
    pub(super) response: Response<f32>,
    pub(super) alone: Response<f32>,
    /// By how much its impulse has changed since those of the locks were.
    pub(super) change: f32,
}

impl Coordinate {
    pub(super) const NONE: Self = Self {
        gradient: Gradient::NONE,
        value: 0.0,
        number: NOT_YET,
        response: Response::NONE,
        alone: Response::NONE,
        change: 0.0,
    };
}

impl Scratch {
    /// Forgets what was found out: bodies have moved, or are others.
    pub(super) fn forget(&mut self) {
        self.known = Known::Nothing;
    }

    pub(super) fn forget_responses(&mut self) {
        self.unit_velocities.clear();
        self.unit_impulses.clear();
        self.coordinates.iter_mut().for_each(|coordinate| coordinate.number = NOT_YET);
    }
}
