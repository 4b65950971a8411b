//! The plugins of the broad phase: its stages, and the one that finds pairs.

use bevy_app::{App, Plugin};
use bevy_ecs::{prelude::*, schedule::ScheduleLabel};
use core::marker::PhantomData;

use super::BroadPhaseSystems;
use crate::{
    collision::{diagnostics::CollisionDiagnostics, pairs::PairSearch},
    schedule::{PhysicsSchedule, PhysicsStepSystems},
    step::{self, Owner},
};

/// The system sets that every broad phase shares.
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

/// Finds pairs with the bounding volume hierarchies of [`ColliderTreePlugin`](crate::collider_tree::ColliderTreePlugin).
///
/// `H` is reserved for the app's collision hooks. It has no effect yet.
pub struct BvhBroadPhasePlugin<H = ()>(PhantomData<fn() -> H>);

impl<H> Default for BvhBroadPhasePlugin<H> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<H: 'static> Plugin for BvhBroadPhasePlugin<H> {
    fn build(&self, app: &mut App) {
        step::add_once(app, SharedBroadPhasePlugin);
    }
}

/// Adds the search for pairs, once for all hooks.
struct SharedBroadPhasePlugin;

impl Plugin for SharedBroadPhasePlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        app.init_resource::<PairSearch>().init_resource::<CollisionDiagnostics>();
        step::add_systems_of(Owner::BroadPhase, app, PhysicsSchedule.intern());
    }
}
