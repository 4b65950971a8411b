//! The broad phase: pairs of colliders whose boxes overlap become contacts for the narrow phase to look at.

mod plugin;

pub use plugin::{BroadPhaseCorePlugin, BvhBroadPhasePlugin};

use bevy_ecs::prelude::*;

/// The stages of the broad phase, in this order, in [`PhysicsStepSystems::BroadPhase`](crate::schedule::PhysicsStepSystems::BroadPhase).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BroadPhaseSystems {
    /// Before pairs are searched.
    First,
    /// Pairs are found, filtered and added as contacts.
    CollectCollisions,
    /// After it.
    Last,
}
