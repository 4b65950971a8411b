//! What becomes of a body whose pose or velocity is not a number: it is put back where it last was, stopped and
//! disabled, with one warning, before anything else can catch it.

use bevy_ecs::prelude::*;
use bevy_log::warn;
use kernel::math::WorldPose;

use crate::{
    dynamics::rigid_body::{AngularVelocity, LinearVelocity, RigidBodyDisabled},
    physics_transform::pose_from_kernel,
};

/// Whether a pose consists of numbers.
pub(crate) fn is_finite(pose: &WorldPose) -> bool {
    pose.position.is_finite_world() && pose.rotation.is_finite()
}

/// Stops and disables a body. `last` is its last good pose; without one it keeps what it was given.
pub(crate) fn quarantine(entity: Entity, last: Option<WorldPose>, commands: &mut Commands) {
    warn!("the position or velocity of {entity} is not finite; it is put back, stopped and disabled");
    let mut body = commands.entity(entity);
    body.try_insert((RigidBodyDisabled, LinearVelocity::ZERO, AngularVelocity::ZERO));
    if let Some(pose) = last {
        body.try_insert(pose_from_kernel(pose));
    }
}
