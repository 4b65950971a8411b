//! The pose of a collider on its body: [`ColliderTransform`], derived from the transforms between them.

mod plugin;

pub use plugin::ColliderTransformPlugin;
#[cfg(test)]
pub(crate) use plugin::Placement;

use bevy_ecs::{prelude::*, reflect::ReflectComponent};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use bevy_transform::components::Transform;

use crate::{
    math::{Vector, vector_from_xyz},
    physics_transform::{Rotation, frame::read_pose},
};

/// The system that updates [`ColliderTransform`]s.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct UpdateColliderTransforms;

/// The pose and scale of a collider relative to its body, derived from the transforms between them. On the
/// body itself, and on colliders without a body, only the scale is used.
///
/// The engine gives the collider this scale, unless
/// [`transform_to_collider_scale`](crate::physics_transform::PhysicsTransformConfig::transform_to_collider_scale)
/// is off.
#[derive(Reflect, Clone, Copy, Component, Debug, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
pub struct ColliderTransform {
    /// The vector from the body's origin to the collider's, in the body's axes, in metres. Includes the
    /// body's scale.
    pub translation: Vector,
    /// The rotation from the body's axes to the collider's.
    pub rotation: Rotation,
    /// The scale of the collider in the world, along its own axes. Negative factors mirror it.
    ///
    /// An entity below a rotated and unevenly scaled ancestor is sheared, but a collider cannot be sheared.
    /// Its scale is then the diagonal of R, where Q R is its transform and Q its rotation: the x axis keeps
    /// its length, and each other axis keeps its component perpendicular to the axes before it.
    pub scale: Vector,
}

impl ColliderTransform {
    /// Transforms a point from the collider's space to the body's: scale, rotate, translate.
    pub fn transform_point(&self, mut point: Vector) -> Vector {
        point *= self.scale;
        self.rotation * point + self.translation
    }
}

impl Default for ColliderTransform {
    fn default() -> Self {
        Self { translation: Vector::ZERO, rotation: Rotation::IDENTITY, scale: Vector::ONE }
    }
}

impl From<Transform> for ColliderTransform {
    fn from(transform: Transform) -> Self {
        let (translation, rotation) = read_pose(None, &transform);
        let scale = vector_from_xyz(transform.scale.to_array().map(f64::from));
        Self { translation, rotation: rotation.unwrap_or(Rotation::IDENTITY), scale }
    }
}
