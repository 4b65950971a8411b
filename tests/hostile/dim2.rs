//! 2D parts of the hostile input. `dim3.rs` has those of 3D.

use avian::{math::Scalar, prelude::*};

/// A pair of this length instead of a unit rotation.
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
