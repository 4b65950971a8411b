//! Converts velocities of 2D bodies to the three dimensions of `Transform`.

use bevy_math::Vec3;

use crate::{
    dynamics::rigid_body::{AngularVelocity, LinearVelocity},
    math::AsF32,
};

/// The linear velocity in the XY plane.
pub(super) fn linear_vec3(velocity: LinearVelocity) -> Vec3 {
    velocity.0.f32().extend(0.0)
}

/// The angular velocity about Z.
pub(super) fn angular_vec3(velocity: AngularVelocity) -> Vec3 {
    Vec3::Z * crate::math::to_f32(velocity.0)
}
