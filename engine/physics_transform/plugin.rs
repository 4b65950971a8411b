//! The plugins of the transform tree, and of the synchronisation between poses and transforms.

use bevy_app::{App, FixedPostUpdate, Plugin, RunFixedMainLoop, RunFixedMainLoopSystems};
use bevy_ecs::{change_detection::CheckChangeTicks, intern::Interned, prelude::*, schedule::ScheduleLabel};
use bevy_transform::components::Transform;

use super::{
    ApplyPosToTransform, PhysicsTransformConfig, PhysicsTransformSystems, Position, Rotation,
    aim::{InFixedLoop, aim, begin_frame, end_fixed_loop},
    follow::Followed,
    position::Originals,
    spawned::{SpawnQueue, initialise_added, initialise_poses, note_rotation},
    sync::{
        SyncTicks, find_changed_transforms, position_to_transform, propagate_global_transforms,
        transform_to_position,
    },
    tree::{
        HierarchyQueue, TransformTree, TreeChanges, enqueue, enqueue_enabled, enqueue_parented, update_tree,
    },
};
use crate::{
    dynamics::rigid_body::RigidBody,
    schedule::{PhysicsSchedule, PhysicsSystems},
    step::{self, Owner},
    threads::Threads,
};

/// Synchronises [`Position`] and [`Rotation`] with `Transform`; see [`PhysicsTransformConfig`].
pub struct PhysicsTransformPlugin {
    schedule: Interned<dyn ScheduleLabel>,
}

impl PhysicsTransformPlugin {
    /// Runs in `schedule`, which must have the sets of [`PhysicsSystems`](crate::schedule::PhysicsSystems).
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern() }
    }
}

impl Default for PhysicsTransformPlugin {
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl Plugin for PhysicsTransformPlugin {
    fn build(&self, app: &mut App) {
        TransformTreePlugin::ensure(app, self.schedule);
        // Registration fails only if the requirement exists already.
        let _ = app.try_register_required_components_with::<RigidBody, Position>(|| Position::PLACEHOLDER);
        let _ = app.try_register_required_components_with::<RigidBody, Rotation>(|| Rotation::PLACEHOLDER);
        let _ = app.try_register_required_components::<Position, Transform>();
        app.init_resource::<PhysicsTransformConfig>()
            .register_type::<(Position, Rotation, PhysicsTransformConfig)>()
            .init_resource::<SpawnQueue>()
            .init_resource::<Originals>()
            .init_resource::<InFixedLoop>()
            .add_systems(
                RunFixedMainLoop,
                (
                    begin_frame
                        .in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop)
                        .run_if(any_with_component::<Followed>),
                    end_fixed_loop
                        .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop)
                        .run_if(any_with_component::<Followed>),
                ),
            )
            .add_observer(initialise_added)
            .add_observer(note_rotation)
            .add_systems(
                self.schedule,
                (
                    initialise_poses,
                    (aim.run_if(any_with_component::<Followed>), transform_to_position)
                        .chain()
                        .run_if(|config: Res<PhysicsTransformConfig>| config.transform_to_position),
                )
                    .chain()
                    .in_set(PhysicsTransformSystems::TransformToPosition),
            )
            .add_systems(
                self.schedule,
                propagate_global_transforms
                    .run_if(|config: Res<PhysicsTransformConfig>| config.propagate_before_physics)
                    .in_set(PhysicsTransformSystems::Propagate)
                    .after(find_changed_transforms),
            )
            .add_systems(
                self.schedule,
                position_to_transform.in_set(PhysicsTransformSystems::PositionToTransform),
            );
        step::install(app);
        step::add_systems_of(Owner::Transforms, app, PhysicsSchedule.intern());
    }
}

/// Adds the tree and the scan of `Transform`. It is added by the first plugin that needs it.
pub(crate) struct TransformTreePlugin(pub(crate) Interned<dyn ScheduleLabel>);

impl TransformTreePlugin {
    /// Adds the plugin unless it was already added.
    pub(crate) fn ensure(app: &mut App, schedule: Interned<dyn ScheduleLabel>) {
        if !app.is_plugin_added::<Self>() {
            app.add_plugins(Self(schedule));
        }
    }
}

impl Plugin for TransformTreePlugin {
    fn build(&self, app: &mut App) {
        use PhysicsTransformSystems::{PositionToTransform, Propagate, TransformToPosition};
        app.init_resource::<HierarchyQueue>()
            .init_resource::<TransformTree>()
            .init_resource::<TreeChanges>()
            .init_resource::<SyncTicks>()
            .init_resource::<Threads>()
            .add_observer(enqueue::<Add, (Position, RigidBody, ApplyPosToTransform)>)
            .add_observer(enqueue::<Remove, (Position, RigidBody, ApplyPosToTransform)>)
            .add_observer(enqueue_parented::<Insert>)
            .add_observer(enqueue_parented::<Remove>)
            .add_observer(enqueue_enabled)
            .add_observer(|check: On<CheckChangeTicks>, mut ticks: ResMut<SyncTicks>| ticks.clamp(*check))
            .configure_sets(
                self.0,
                ((Propagate, TransformToPosition).chain().in_set(PhysicsSystems::Prepare),),
            )
            .configure_sets(self.0, PositionToTransform.in_set(PhysicsSystems::Writeback))
            .add_systems(self.0, (update_tree, find_changed_transforms).chain().in_set(Propagate));
    }
}
