//! 3D parts of the hostile input. `dim2.rs` has those of 2D.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};

/// A quaternion of this length instead of a unit rotation.
pub fn scaled(length: Scalar) -> Rotation {
    Rotation(Rotation::IDENTITY.0 * length)
}

/// An angular velocity about z.
pub fn spin(spin: Scalar) -> AngularVelocity {
    AngularVelocity(Vector::Z * spin)
}

/// An angular inertia of this value about all axes.
pub fn inertia(value: f32) -> AngularInertia {
    AngularInertia { principal: bevy_math::Vec3::splat(value), local_frame: bevy_math::Quat::IDENTITY }
}
