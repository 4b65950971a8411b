//! Positions and rotations of bodies and colliders, and their synchronisation with `Transform`.
//!
//! - Before a step, transforms that the app changed are read into [`Position`] and [`Rotation`].
//! - After the step, the poses of bodies that moved are written back, relative to the parent if there is one.
//! - If the app set both since the last step, the pose takes precedence over the transform, separately for
//!   position and rotation.
//! - Bodies move independently of their parents in the simulation. A change to a parent's `Transform` by the
//!   app moves the bodies below it.
//! - A kinematic body with [`FollowTransform`] moves to its transform by velocity, and its transform is not
//!   written.

/// Implements `$left * $right` for all combinations of values, references and mutable references.
macro_rules! by_reference {
    ($left:ty, $right:ty => $out:ty, |$a:ident, $b:ident| $body:expr) => {
        by_reference!(@one $left, $right => $out, |$a, $b| $body);
        by_reference!(@one $left, &$right => $out, |$a, $b| { let $b = *$b; $body });
        by_reference!(@one $left, &mut $right => $out, |$a, $b| { let $b = *$b; $body });
        by_reference!(@one &$left, $right => $out, |$a, $b| $body);
        by_reference!(@one &$left, &$right => $out, |$a, $b| { let $b = *$b; $body });
        by_reference!(@one &$left, &mut $right => $out, |$a, $b| { let $b = *$b; $body });
        by_reference!(@one &mut $left, $right => $out, |$a, $b| $body);
        by_reference!(@one &mut $left, &$right => $out, |$a, $b| { let $b = *$b; $body });
        by_reference!(@one &mut $left, &mut $right => $out, |$a, $b| { let $b = *$b; $body });
    };
    (@one $left:ty, $right:ty => $out:ty, |$a:ident, $b:ident| $body:expr) => {
        impl core::ops::Mul<$right> for $left {
            type Output = $out;
            fn mul(self, $b: $right) -> $out {
                let $a = self;
                $body
            }
        }
    };
}

mod aim;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
pub(crate) mod follow;
pub(crate) mod frame;
mod helper;
mod kernel_pose;
pub(crate) mod plugin;
mod position;
mod pre_solve;
mod rotation64;
mod rotation_ops;
pub(crate) mod spawned;
pub(crate) mod sync;
#[cfg(test)]
mod tests;
pub(crate) mod tree;

pub use dim::Rotation;
pub use follow::FollowTransform;
pub use helper::PhysicsTransformHelper;
pub(crate) use kernel_pose::{filled_in, pose_from_kernel, said_pose, unit_rotation, world_pose};
pub use plugin::PhysicsTransformPlugin;
pub use position::Position;
pub use pre_solve::{PreSolveDeltaPosition, PreSolveDeltaRotation};
pub use sync::{position_to_transform, transform_to_position};

use bevy_ecs::{prelude::*, reflect::ReflectResource};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

/// Settings of the synchronisation between transforms and poses. All are on by default.
#[derive(Resource, Reflect, Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Resource, Default, Debug, PartialEq)]
pub struct PhysicsTransformConfig {
    /// Whether a change to an ancestor's `Transform` moves the bodies and colliders below it, and whether
    /// their `GlobalTransform` is updated before each step.
    pub propagate_before_physics: bool,
    /// Whether changed transforms are read before a step. New bodies are always initialised from their
    /// transforms.
    pub transform_to_position: bool,
    /// Whether poses are written to transforms after a step.
    pub position_to_transform: bool,
    /// Whether colliders follow the scale of their `GlobalTransform`, before each step.
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

/// System sets of the synchronisation.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PhysicsTransformSystems {
    /// Find changes of the hierarchy and its transforms. First in
    /// [`PhysicsSystems::Prepare`](crate::schedule::PhysicsSystems::Prepare).
    Propagate,
    /// Read changed transforms into poses. In
    /// [`PhysicsSystems::Prepare`](crate::schedule::PhysicsSystems::Prepare).
    TransformToPosition,
    /// Write poses that changed to transforms. In
    /// [`PhysicsSystems::Writeback`](crate::schedule::PhysicsSystems::Writeback).
    PositionToTransform,
}

/// The former name of [`PhysicsTransformSystems`].
#[deprecated(note = "renamed to `PhysicsTransformSystems`")]
pub type PhysicsTransformSet = PhysicsTransformSystems;

/// Converts an `f64` rotation. Returns the identity if it cannot be normalised.
pub(crate) fn rotation_from_f64(turn: rotation64::Rotation64) -> Rotation {
    Rotation::from_f64(turn).unwrap_or(Rotation::IDENTITY)
}

/// Enables writing the pose of an entity without a rigid body to its `Transform` after a step.
#[derive(Component, Default)]
pub struct ApplyPosToTransform;
