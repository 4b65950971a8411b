//! The narrow phase: where the boxes of two colliders overlap, their shapes are compared and contact points computed.

mod plugin;

pub use plugin::NarrowPhasePlugin;

use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::{dynamics::solver::config::LINEAR_SLOP, math::Scalar};

/// Whether contacts push: false leaves detection and events, without a response.
#[derive(Resource, Clone, Copy, Debug)]
pub(crate) struct ContactResponse(pub(crate) bool);

/// Where collision events are sent, in [`PhysicsStepSystems::Finalize`](crate::schedule::PhysicsStepSystems::Finalize).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CollisionEventSystems;

/// How contacts are computed.
#[derive(Resource, Reflect, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Resource, Default, PartialEq)]
pub struct NarrowPhaseConfig {
    /// The [`SpeculativeMargin`](crate::dynamics::ccd::SpeculativeMargin) of colliders and bodies without one, in metres. Unbounded by default.
    pub default_speculative_margin: Scalar,
    /// How far apart two shapes at rest may be and still be in contact, times
    /// [`PhysicsLengthUnit`](crate::dynamics::solver::PhysicsLengthUnit); 0.005 by default. At 0 resting contacts flicker.
    pub contact_tolerance: Scalar,
    /// Whether contact points take over the impulses of the points they were in the last step; true by default. Without, stacks sag.
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

/// The stages of the narrow phase, in this order, in [`PhysicsStepSystems::NarrowPhase`](crate::schedule::PhysicsStepSystems::NarrowPhase).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NarrowPhaseSystems {
    /// Before contacts are computed.
    First,
    /// Contacts are computed.
    Update,
    /// After it.
    Last,
}

/// The former name of [`NarrowPhaseSystems`].
#[deprecated(since = "0.4.0", note = "renamed to `NarrowPhaseSystems`")]
pub type NarrowPhaseSet = NarrowPhaseSystems;
