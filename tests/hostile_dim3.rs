//! What hostile input must know of space. `hostile_dim2.rs` is the twin.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};

/// No rotation, but of this length.
pub fn scaled(length: Scalar) -> Rotation {
    Rotation(Rotation::IDENTITY.0 * length)
}

/// An angular velocity about z.
pub fn spin(spin: Scalar) -> AngularVelocity {
    AngularVelocity(Vector::Z * spin)
}
