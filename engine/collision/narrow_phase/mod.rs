//! The narrow phase: contact points of pairs whose boxes overlap.

pub(crate) mod input;
mod plugin;

pub use plugin::NarrowPhasePlugin;

use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::{dynamics::solver::config::LINEAR_SLOP, math::Scalar};

/// Whether contacts are solved. False leaves detection without response.
#[derive(Resource, Clone, Copy, Debug)]
pub(crate) struct ContactResponse(pub(crate) bool);

/// System set for sending collision events, in
/// [`PhysicsStepSystems::Finalize`](crate::schedule::PhysicsStepSystems::Finalize).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CollisionEventSystems;

/// Settings of the narrow phase.
#[derive(Resource, Reflect, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Resource, Default, PartialEq)]
pub struct NarrowPhaseConfig {
    /// The [`SpeculativeMargin`](crate::dynamics::ccd::SpeculativeMargin) of colliders and bodies without
    /// one, in metres. Unbounded by default.
    pub default_speculative_margin: Scalar,
    /// Maximum distance of two shapes at rest that are in contact, times
    /// [`PhysicsLengthUnit`](crate::dynamics::solver::PhysicsLengthUnit). 0.005 by default. With 0 resting
    /// contacts flicker.
    pub contact_tolerance: Scalar,
    /// Whether contact points start from the impulses of the same points in the last step. True by default.
    /// Without it stacks sag.
    pub match_contacts: bool,
}

impl Default for NarrowPhaseConfig {
    fn default() -> Self {
        Self {
            default_speculative_margin: Scalar::MAX,
            contact_tolerance: LINEAR_SLOP as Scalar,
            match_contacts: true,
        }
    }
}

/// System sets of the narrow phase, in this order, in
/// [`PhysicsStepSystems::NarrowPhase`](crate::schedule::PhysicsStepSystems::NarrowPhase).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NarrowPhaseSystems {
    /// Before contacts are computed.
    First,
    /// Contacts are computed.
    Update,
    /// After contacts were computed.
    Last,
}

/// The former name of [`NarrowPhaseSystems`].
#[deprecated(since = "0.4.0", note = "renamed to `NarrowPhaseSystems`")]
pub type NarrowPhaseSet = NarrowPhaseSystems;
