//! Poses to and from the kernel.

use bevy_ecs::change_detection::{DetectChangesMut, Mut};
use kernel::math::WorldPose;

use super::{Position, Rotation};
use crate::math::{world_from_kernel, world_to_kernel};

/// The pose of a body or collider, for the kernel.
#[inline]
pub(crate) fn world_pose(position: &Position, rotation: &Rotation) -> WorldPose {
    WorldPose::new(world_to_kernel(position.0), rotation.to_kernel())
}

/// Writes a pose from the kernel; each component is marked as changed only if it does.
#[inline]
pub(crate) fn set_pose(mut position: Mut<Position>, mut rotation: Mut<Rotation>, pose: WorldPose) {
    position.set_if_neq(Position(world_from_kernel(pose.position)));
    rotation.set_if_neq(Rotation::from_kernel(pose.rotation));
}
