//! 2D parts of the tests of joints.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{math::Scalar, prelude::*};
use bevy_ecs::prelude::*;

use super::joints::{INERTIA, MASS};

/// A body without a collider.
pub fn rod() -> impl Bundle {
    (RigidBody::Dynamic, Mass(MASS as f32), AngularInertia(INERTIA as f32))
}

/// The angle about z, in radians.
pub fn angle_of(rotation: Rotation) -> Scalar {
    rotation.as_radians()
}

/// The component about z.
pub fn spin_of(velocity: AngularVelocity) -> Scalar {
    velocity.0
}

/// A wheel that spins about z.
pub fn dim_wheel(wheel: WheelJoint) -> WheelJoint {
    wheel
}
