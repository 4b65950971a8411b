//! Poses in 3D.

use avian::{
    math::{Quaternion, Scalar, Vector},
    parry::math::Pose,
    prelude::Rotation,
};

/// A rotation by an angle, about an axis that is none of a shape's.
pub fn turned(angle: f64) -> Rotation {
    Rotation(Quaternion::from_axis_angle(Vector::new(1.0, 2.0, 3.0).normalize(), angle as Scalar))
}

/// A pose of parry.
pub fn pose(position: Vector, rotation: Rotation) -> Pose {
    Pose::from_parts(position, rotation.0)
}
