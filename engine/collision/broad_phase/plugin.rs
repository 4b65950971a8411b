//! The plugins of the broad phase: one adds its stages, the other finds pairs.

use bevy_app::{App, Plugin};
use bevy_ecs::{prelude::*, schedule::ScheduleLabel, system::SystemParamItem};
use core::{any::TypeId, marker::PhantomData};

use super::BroadPhaseSystems;
use crate::{
    collision::{
        diagnostics::CollisionDiagnostics,
        hooks::{CollisionHooks, filter_pairs},
        pairs::{FilterPairs, PairSearch, find_new_pairs},
    },
    schedule::{PhysicsSchedule, PhysicsStepSystems},
    step::{self, Owner, Stage},
};

/// The system sets that every broad phase shares.
///
/// To use your own, disable [`BvhBroadPhasePlugin`] and add pairs to
/// [`ContactGraph`](crate::collision::contact_types::ContactGraph) in
/// [`BroadPhaseSystems::CollectCollisions`].
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

/// Finds pairs with the bounding volume hierarchies of
/// [`ColliderTreePlugin`](crate::collider_tree::ColliderTreePlugin).
///
/// `H` are the [`CollisionHooks`] that filter pairs.
pub struct BvhBroadPhasePlugin<H: CollisionHooks = ()>(PhantomData<fn() -> H>);

impl<H: CollisionHooks> Default for BvhBroadPhasePlugin<H> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<H: CollisionHooks + 'static> Plugin for BvhBroadPhasePlugin<H>
where
    for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
{
    fn build(&self, app: &mut App) {
        step::add_once(app, SharedBroadPhasePlugin);
        if TypeId::of::<H>() != TypeId::of::<()>() {
            let filter = filter_pairs::<H>.in_set(FilterPairs).in_set(Stage::FindPairs).after(find_new_pairs);
            step::add_systems(app, PhysicsSchedule, filter);
        }
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
