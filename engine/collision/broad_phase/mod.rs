//! The broad phase: pairs of colliders with overlapping boxes become contacts for the narrow phase.

mod plugin;

pub use plugin::{BroadPhaseCorePlugin, BvhBroadPhasePlugin};

use bevy_ecs::prelude::*;

/// System sets of the broad phase, in this order, in
/// [`PhysicsStepSystems::BroadPhase`](crate::schedule::PhysicsStepSystems::BroadPhase).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BroadPhaseSystems {
    /// Before pairs are searched.
    First,
    /// Pairs are found, filtered and added as contacts.
    CollectCollisions,
    /// After pairs were added.
    Last,
}
