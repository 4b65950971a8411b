//! Rotations and frames of 3D joints. `space2.rs` exports the same names.

use bevy_math::{Isometry3d, Vec3};
use kernel::{
    math as k,
    solver::coordinate::{SWING_Y, SWING_Z, TWIST, X, Y, Z},
};

use crate::{
    math::{AdjustPrecision, AngularVector, AsF32, Quaternion, Scalar, Vector, orthonormal_basis_from_vec},
    physics_transform::Rotation,
};

/// The rotation of a basis.
pub(crate) type Rot = Quaternion;
/// A frame in `f32`.
pub(crate) type Isometry = Isometry3d;

/// The coordinates of a position.
pub(super) const TRANSLATIONS: [usize; 3] = [X, Y, Z];
/// Those across the x axis.
pub(super) const ACROSS: [usize; 2] = [Y, Z];
/// The coordinates of a rotation.
pub(super) const ROTATIONS: [usize; 3] = [TWIST, SWING_Y, SWING_Z];

/// No torque.
pub(super) const NO_TORQUE: AngularVector = Vector::ZERO;

/// The rotation of a basis, with its operations.
pub(crate) fn rotation_of(basis: Rot) -> Rotation {
    Rotation(basis)
}

/// The basis with a rotation.
pub(crate) fn basis_of(rotation: Rotation) -> Rot {
    rotation.0
}

/// Translation and rotation of a frame.
pub(super) fn parts(isometry: Isometry) -> (Vector, Rot) {
    (Vec3::from(isometry.translation).adjust_precision(), isometry.rotation.adjust_precision())
}

/// The frame with a translation and a rotation.
pub(super) fn isometry(translation: Vector, rotation: Rot) -> Isometry {
    Isometry3d::new(translation.f32(), rotation.f32())
}

/// The rotation that takes the x axis to an axis; not finite if that has no direction. The turn about the axis depends on
/// the axis only.
pub(super) fn turn_to(axis: Vector) -> k::Rot {
    let turn = match axis.try_normalize() {
        Some(axis) => orthonormal_basis_from_vec(axis),
        None => Quaternion::from_xyzw(0.0, 0.0, 0.0, Scalar::NAN),
    };
    Rotation(turn).to_kernel().admitted()
}
