//! Converts velocities of 3D bodies to the precision of `Transform`.

use bevy_math::Vec3;

use crate::{
    dynamics::rigid_body::{AngularVelocity, LinearVelocity},
    math::AsF32,
};

/// The linear velocity in single precision.
pub(super) fn linear_vec3(velocity: LinearVelocity) -> Vec3 {
    velocity.0.f32()
}

/// The angular velocity in single precision.
pub(super) fn angular_vec3(velocity: AngularVelocity) -> Vec3 {
    velocity.0.f32()
}
