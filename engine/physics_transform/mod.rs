//! Positions and rotations of bodies and colliders, and how they are kept in step with `Transform`.
//!
//! - Before a step, transforms that the user changed are read into [`Position`] and [`Rotation`].
//! - After it, the poses of bodies that moved are written back, relative to the parent if there is one.
//! - If both were set since the last step, the pose wins over the transform, each of position and rotation
//!   for itself.
//! - Bodies move independently of their parents in the simulation. What is set on a parent's `Transform`
//!   moves the bodies below along.

use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::{
    intern::Interned,
    prelude::*,
    reflect::ReflectResource,
    schedule::{ScheduleLabel, SystemSet},
};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use bevy_transform::components::Transform;

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
pub(crate) mod frame;
mod helper;
mod kernel_pose;
mod position;
mod rotation_ops;
mod sync;
#[cfg(test)]
mod tests;
pub(crate) mod tree;

pub use dim::Rotation;
pub(crate) use dim::vector_from_xyz;
pub use helper::PhysicsTransformHelper;
pub(crate) use kernel_pose::{set_pose, world_pose};
pub use position::Position;
pub(crate) use sync::find_changed_transforms;
pub use sync::{position_to_transform, transform_to_position};

use crate::dynamics::rigid_body::RigidBody;
use tree::TransformTreePlugin;

/// Keeps [`Position`] and [`Rotation`] in step with `Transform`; see [`PhysicsTransformConfig`].
pub struct PhysicsTransformPlugin {
    schedule: Interned<dyn ScheduleLabel>,
}

impl PhysicsTransformPlugin {
    /// Runs the sync in `schedule`, where [`PhysicsSystems`](crate::schedule::PhysicsSystems) run.
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
        // Each fails only where the requirement is there already.
        let _ = app.try_register_required_components_with::<RigidBody, Position>(|| Position::PLACEHOLDER);
        let _ = app.try_register_required_components_with::<RigidBody, Rotation>(|| Rotation::PLACEHOLDER);
        let _ = app.try_register_required_components::<Position, Transform>();
        app.init_resource::<PhysicsTransformConfig>()
            .register_type::<(Position, Rotation, PhysicsTransformConfig)>()
            .init_resource::<sync::SpawnQueue>()
            .add_observer(sync::initialise_added)
            .add_observer(sync::note_rotation)
            .add_systems(
                self.schedule,
                (
                    sync::initialise_poses,
                    transform_to_position
                        .run_if(|config: Res<PhysicsTransformConfig>| config.transform_to_position),
                )
                    .chain()
                    .in_set(PhysicsTransformSystems::TransformToPosition),
            )
            .add_systems(
                self.schedule,
                position_to_transform.in_set(PhysicsTransformSystems::PositionToTransform),
            );
    }
}

/// What the sync between transforms and poses does. Everything is on by default.
#[derive(Resource, Reflect, Clone, Debug, PartialEq, Eq)]
#[reflect(Resource, Default, Debug, PartialEq)]
pub struct PhysicsTransformConfig {
    /// Whether a change to an ancestor's `Transform` moves the bodies and colliders below.
    pub propagate_before_physics: bool,
    /// Whether changed transforms are read before a step. New bodies are initialised from theirs anyway.
    pub transform_to_position: bool,
    /// Whether poses are written to transforms after a step.
    pub position_to_transform: bool,
    /// Whether the scale of a `Transform` scales the collider.
    pub transform_to_collider_scale: bool,
}

impl Default for PhysicsTransformConfig {
    fn default() -> Self {
        Self {
            propagate_before_physics: true,
            transform_to_position: true,
            position_to_transform: true,
            transform_to_collider_scale: true,
        }
    }
}

/// When the sync runs.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PhysicsTransformSystems {
    /// Finds what changed in the hierarchy and its transforms. First in
    /// [`PhysicsSystems::Prepare`](crate::schedule::PhysicsSystems::Prepare).
    Propagate,
    /// Reads changed transforms into poses. In
    /// [`PhysicsSystems::Prepare`](crate::schedule::PhysicsSystems::Prepare).
    TransformToPosition,
    /// Writes poses that moved to transforms. In
    /// [`PhysicsSystems::Writeback`](crate::schedule::PhysicsSystems::Writeback).
    PositionToTransform,
}

/// The former name of [`PhysicsTransformSystems`].
#[deprecated(note = "renamed to `PhysicsTransformSystems`")]
pub type PhysicsTransformSet = PhysicsTransformSystems;

/// The rotation of a frame; none where it has no direction.
pub(crate) fn turn_to_rotation(turn: frame::Turn) -> Rotation {
    Rotation::from_turn(turn).unwrap_or(Rotation::IDENTITY)
}

/// Makes the pose of an entity without a rigid body be written to its `Transform` after a step.
#[derive(Component, Default)]
pub struct ApplyPosToTransform;
