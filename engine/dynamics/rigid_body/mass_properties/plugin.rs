//! The plugin of mass properties.

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

/// Computes mass properties of bodies. Part of `PhysicsPlugins`.
///
/// A body's mass is computed when the body is spawned, and at the end of each command that added, removed or
/// replaced a collider or made it a sensor. With hundreds of colliders it is only computed before the next
/// step. Before a step only bodies with
/// [`RecomputeMassProperties`](super::components::RecomputeMassProperties) are computed, so resting worlds
/// cost nothing. The engine inserts this marker when a body is spawned or changes type; when one of its
/// colliders is added, removed, disabled, moved on the body, becomes a sensor, or changes shape or density;
/// when one of the components named in the [module](super) is added, removed or changed on the body or a
/// descendant. The engine does not detect that a descendant *without a collider* moves because of an entity
/// between it and the body: insert the marker in this case.
pub struct MassPropertyPlugin {
    schedule: Interned<dyn ScheduleLabel>,
}

impl MassPropertyPlugin {
    /// Computes in `schedule`, which hosts physics. [`FixedPostUpdate`] by default.
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
