//! Quarantine of bodies with a pose or velocity that is not finite. The body is reset to its last pose,
//! stopped and disabled, with one warning, before NaN spreads.

use bevy_ecs::prelude::*;
use bevy_log::warn;
use kernel::math::WorldPose;

use crate::{
    dynamics::rigid_body::{AngularVelocity, LinearVelocity, RigidBodyDisabled},
    physics_transform::pose_from_kernel,
};

/// Whether a pose is finite.
pub(crate) fn is_finite(pose: &WorldPose) -> bool {
    pose.position.is_finite_world() && pose.rotation.is_finite()
}

/// Stops and disables a body, and resets it to `last`, its last finite pose. Without `last` the body keeps
/// its pose.
pub(crate) fn quarantine(entity: Entity, last: Option<WorldPose>, commands: &mut Commands) {
    warn!("the position or velocity of {entity} is not finite; it is put back, stopped and disabled");
    let mut body = commands.entity(entity);
    body.try_insert((RigidBodyDisabled, LinearVelocity::ZERO, AngularVelocity::ZERO));
    if let Some(pose) = last {
        body.try_insert(pose_from_kernel(pose));
    }
}
