//! Conversion of poses to and from the kernel.

use kernel::math::{Rot, WorldPose};

use super::{Position, Rotation};
use crate::math::{world_from_kernel, world_to_kernel};

/// The pose of a body or collider, for the kernel.
pub(crate) fn world_pose(position: &Position, rotation: &Rotation) -> WorldPose {
    WorldPose::new(world_to_kernel(position.0), unit_rotation(rotation))
}

/// The exact pose of the components, to detect changes by the app. It may be invalid.
#[inline]
pub(crate) fn said_pose(position: &Position, rotation: &Rotation) -> WorldPose {
    WorldPose::new(world_to_kernel(position.0), rotation.to_kernel())
}

/// A rotation for the kernel, of unit length. A rotation of length 0 becomes NaN.
pub(crate) fn unit_rotation(rotation: &Rotation) -> Rot {
    filled_in(*rotation).to_kernel().admitted()
}

/// The rotation, or the identity for a placeholder.
pub(crate) fn filled_in(rotation: Rotation) -> Rotation {
    if rotation == Rotation::PLACEHOLDER { Rotation::IDENTITY } else { rotation }
}

/// Converts a pose of the kernel to components.
#[inline(always)]
pub(crate) fn pose_from_kernel(pose: WorldPose) -> (Position, Rotation) {
    (Position(world_from_kernel(pose.position)), Rotation::from_kernel(pose.rotation))
}
