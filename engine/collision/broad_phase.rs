//! The broad phase: pairs of colliders whose boxes overlap become contacts for the narrow phase to look at.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use core::marker::PhantomData;

use super::{
    CollisionDiagnostics,
    pairs::{FoundPairs, find_new_pairs},
};
use crate::{
    schedule::{PhysicsSchedule, PhysicsStepSystems},
    step::{self, Stage},
};

/// The stages that every broad phase shares.
///
/// To use your own, disable [`BvhBroadPhasePlugin`] and add contacts in [`BroadPhaseSystems::CollectCollisions`].
pub struct BroadPhaseCorePlugin;

impl Plugin for BroadPhaseCorePlugin {
    fn build(&self, app: &mut App) {
        app.configure_sets(
            PhysicsSchedule,
            (BroadPhaseSystems::First, BroadPhaseSystems::CollectCollisions, BroadPhaseSystems::Last)
                .chain()
                .in_set(PhysicsStepSystems::BroadPhase),
        );
    }
}

/// The stages of the broad phase, in this order, in [`PhysicsStepSystems::BroadPhase`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BroadPhaseSystems {
    /// Before pairs are searched.
    First,
    /// Pairs are found, filtered and added as contacts.
    CollectCollisions,
    /// After it.
    Last,
}

/// Finds pairs with the bounding volume hierarchies of [`ColliderTreePlugin`](crate::collider_tree::ColliderTreePlugin).
pub struct BvhBroadPhasePlugin<H = ()>(PhantomData<fn() -> H>);

impl<H> Default for BvhBroadPhasePlugin<H> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<H: 'static> Plugin for BvhBroadPhasePlugin<H> {
    fn build(&self, app: &mut App) {
        step::install(app);
        app.init_resource::<FoundPairs>()
            .init_resource::<CollisionDiagnostics>()
            .add_systems(PhysicsSchedule, find_new_pairs.in_set(Stage::FindPairs));
    }
}
