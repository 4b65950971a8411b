//! The plugin of the collider trees.

use bevy_app::{App, Plugin};
use bevy_ecs::{prelude::*, schedule::ScheduleLabel};
use core::marker::PhantomData;

use super::{
    ColliderTreeSystems, diagnostics::ColliderTreeDiagnostics, optimization::ColliderTreeOptimization,
};
use crate::{
    collision::{broad_phase::BroadPhaseSystems, collider::AnyCollider},
    diagnostics::{Within, list},
    dynamics::solver::config::PhysicsLengthUnit,
    schedule::{PhysicsSchedule, PhysicsStepSystems},
    step::{self, Owner},
};

/// Updates the trees for colliders of type `C`. Add one instance per collider type. All instances
/// share the trees.
pub struct ColliderTreePlugin<C: AnyCollider>(PhantomData<fn() -> C>);

impl<C: AnyCollider> Default for ColliderTreePlugin<C> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<C: AnyCollider> Plugin for ColliderTreePlugin<C> {
    fn build(&self, app: &mut App) {
        step::add_once(app, SharedTreePlugin);
    }
}

/// Adds the trees and their system sets, once for all collider types.
struct SharedTreePlugin;

impl Plugin for SharedTreePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ColliderTreeOptimization>().init_resource::<PhysicsLengthUnit>();
        list::<ColliderTreeDiagnostics>(app, Within::Step);
        step::install(app);
        step::add_systems_of(Owner::Trees, app, PhysicsSchedule.intern());

        app.configure_sets(
            PhysicsSchedule,
            (
                ColliderTreeSystems::UpdateAabbs
                    .in_set(PhysicsStepSystems::BroadPhase)
                    .after(BroadPhaseSystems::First)
                    .before(BroadPhaseSystems::CollectCollisions),
                ColliderTreeSystems::BeginOptimize
                    .in_set(PhysicsStepSystems::BroadPhase)
                    .after(BroadPhaseSystems::Last),
                ColliderTreeSystems::EndOptimize.in_set(PhysicsStepSystems::Finalize),
            ),
        );
    }
}
