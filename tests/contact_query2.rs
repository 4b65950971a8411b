//! Poses in 2D.

use avian::{
    math::{Scalar, Vector},
    parry::math::{Pose, Rot2},
    prelude::Rotation,
};

/// A rotation by an angle.
pub fn turned(angle: f64) -> Rotation {
    Rotation::radians(angle as Scalar)
}

/// A pose of parry.
pub fn pose(position: Vector, rotation: Rotation) -> Pose {
    Pose::from_parts(position, Rot2::from_cos_sin_unchecked(rotation.cos, rotation.sin))
}
