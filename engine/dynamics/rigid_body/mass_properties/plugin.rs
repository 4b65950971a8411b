//! The plugin that keeps mass properties.

use bevy_app::{FixedPostUpdate, prelude::*};
use bevy_ecs::{intern::Interned, prelude::*, schedule::ScheduleLabel};

use super::{
    MassPropertySystems,
    queue::{observe, queue_changed, recompute, warn_of_missing_mass},
};
use crate::{
    physics_transform::PhysicsTransformSystems,
    schedule::{PhysicsSchedule, PhysicsSystems},
    step::{self, Owner},
};

/// Keeps the computed mass properties of bodies up to date. Part of `PhysicsPlugins`.
///
/// A body is computed when it is spawned, and when the command is done with which a collider came, went, was replaced or
/// became a sensor; one with hundreds of colliders only before the next step. Before a step a body is computed if it
/// carries [`RecomputeMassProperties`](super::components::RecomputeMassProperties), never otherwise, so that resting
/// worlds cost nothing. The marker is inserted when the body is spawned or changes
/// type; when one of its colliders comes, goes, changes shape or density, becomes a sensor, is disabled or is
/// moved within the body; when one of the components named in the [module](super) comes, goes or changes, on the
/// body or on a descendant. What goes unseen is a change of place of a descendant *without collider* that comes
/// from an entity between it and the body: insert the marker then.
pub struct MassPropertyPlugin {
    schedule: Interned<dyn ScheduleLabel>,
}

impl MassPropertyPlugin {
    /// Computes in `schedule`, in which physics runs; [`FixedPostUpdate`] by default.
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern() }
    }
}

impl Default for MassPropertyPlugin {
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl Plugin for MassPropertyPlugin {
    fn build(&self, app: &mut App) {
        observe(app);
        app.configure_sets(
            self.schedule,
            (
                MassPropertySystems::UpdateColliderMassProperties,
                MassPropertySystems::QueueRecomputation,
                MassPropertySystems::UpdateComputedMassProperties,
            )
                .chain()
                .in_set(PhysicsSystems::Prepare)
                .after(PhysicsTransformSystems::TransformToPosition),
        );
        step::add_systems_of(Owner::MassProperties, app, PhysicsSchedule.intern());
        app.add_systems(
            self.schedule,
            (
                queue_changed.in_set(MassPropertySystems::QueueRecomputation),
                (recompute, warn_of_missing_mass)
                    .chain_ignore_deferred()
                    .in_set(MassPropertySystems::UpdateComputedMassProperties),
            ),
        );
    }
}
