//! Poses to and from the kernel.

use kernel::math::{Rot, WorldPose};

use super::{Position, Rotation};
use crate::math::{world_from_kernel, world_to_kernel};

/// The pose of a body or collider, for the kernel.
pub(crate) fn world_pose(position: &Position, rotation: &Rotation) -> WorldPose {
    WorldPose::new(world_to_kernel(position.0), unit_rotation(rotation))
}

/// The pose of a body or collider as its components say it, whatever that is worth: to see whether the app
/// changed them.
#[inline]
pub(crate) fn said_pose(position: &Position, rotation: &Rotation) -> WorldPose {
    WorldPose::new(world_to_kernel(position.0), rotation.to_kernel())
}

/// A rotation for the kernel, of unit length; one of no length is not finite.
pub(crate) fn unit_rotation(rotation: &Rotation) -> Rot {
    filled_in(*rotation).to_kernel().admitted()
}

/// None, where nobody filled a rotation in.
pub(crate) fn filled_in(rotation: Rotation) -> Rotation {
    if rotation == Rotation::PLACEHOLDER { Rotation::IDENTITY } else { rotation }
}

/// The pose of the components for one of the kernel.
#[inline(always)]
pub(crate) fn pose_from_kernel(pose: WorldPose) -> (Position, Rotation) {
    (Position(world_from_kernel(pose.position)), Rotation::from_kernel(pose.rotation))
}
