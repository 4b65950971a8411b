//! What hostile input must know of the plane. `dim3.rs` is the twin.

use avian::{math::Scalar, prelude::*};

/// No rotation, but of this length.
pub fn scaled(length: Scalar) -> Rotation {
    Rotation::from_sin_cos(0.0, length)
}

/// An angular velocity about z.
pub fn spin(spin: Scalar) -> AngularVelocity {
    AngularVelocity(spin)
}

/// An angular inertia of this value.
pub fn inertia(value: f32) -> AngularInertia {
    AngularInertia(value)
}
