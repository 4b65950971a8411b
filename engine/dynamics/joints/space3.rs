//! Rotations and frames of 3D joints. `space2.rs` exports the same names.

use bevy_math::{Isometry3d, Vec3};
use kernel::{
    math as k,
    solver::coordinate::{SWING_Y, SWING_Z, TWIST, X, Y, Z},
};

use crate::{
    math::{
        AdjustPrecision, AngularVector, AsF32, Quaternion, Scalar, Vector, orthonormal_basis,
        orthonormal_basis_from_vec,
    },
    physics_transform::Rotation,
};

/// The rotation of a basis.
pub(crate) type Rot = Quaternion;
/// A frame in `f32`.
pub(crate) type Isometry = Isometry3d;

/// The coordinates of a position.
pub(super) const TRANSLATIONS: [usize; 3] = [X, Y, Z];
/// The coordinates perpendicular to the x axis.
pub(super) const ACROSS: [usize; 2] = [Y, Z];
/// The coordinates of a rotation.
pub(super) const ROTATIONS: [usize; 3] = [TWIST, SWING_Y, SWING_Z];

/// No torque.
pub(super) const NO_TORQUE: AngularVector = Vector::ZERO;

/// The magnitude of a torque, in N·m.
pub(super) fn magnitude(torque: AngularVector) -> Scalar {
    torque.length()
}

/// The rotation of a basis, as a [`Rotation`].
pub(crate) fn rotation_of(basis: Rot) -> Rotation {
    Rotation(basis)
}

/// The basis of a [`Rotation`].
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

/// The rotation that takes the x axis to `axis`. Not finite if `axis` has no direction. The twist about
/// `axis` depends only on `axis`.
pub(super) fn turn_to(axis: Vector) -> k::Rot {
    let turn = match axis.try_normalize() {
        Some(axis) => orthonormal_basis_from_vec(axis),
        None => Quaternion::from_xyzw(0.0, 0.0, 0.0, Scalar::NAN),
    };
    Rotation(turn).to_kernel().admitted()
}

/// The rotation that takes the x axis to `x`, and the y axis to the component of `y` perpendicular to `x`.
/// Not finite if `x` and `y` span no plane.
pub(super) fn turn_to_plane(x: Vector, y: Vector) -> k::Rot {
    let along = x.try_normalize();
    let normal = along.and_then(|along| along.cross(y).try_normalize());
    let turn = match (along, normal) {
        (Some(x), Some(z)) => orthonormal_basis([x, z.cross(x), z]),
        _ => Quaternion::from_xyzw(0.0, 0.0, 0.0, Scalar::NAN),
    };
    Rotation(turn).to_kernel().admitted()
}

/// The frame rotation of a joint that turns about an axis.
pub(super) fn turn_about(axis: Vector) -> k::Rot {
    turn_to(axis)
}

/// A coordinate of a joint: a position or angle of its second frame relative to its first.
///
/// A rotation is a twist about the x axis, then a swing about an axis perpendicular to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JointCoordinate {
    /// Along the first frame's x axis, in m.
    X = X as isize,
    /// Along the first frame's y axis, in m.
    Y = Y as isize,
    /// Along the first frame's z axis, in m.
    Z = Z as isize,
    /// The angle about the x axes, in rad. With limits, full turns are counted.
    Twist = TWIST as isize,
    /// The swing rotates the first x axis to the second. This is the component of its rotation vector along
    /// the first frame's y axis, in rad.
    SwingY = SWING_Y as isize,
    /// The component of the swing's rotation vector along the first frame's z axis, in rad.
    SwingZ = SWING_Z as isize,
}

/// The number of coordinates.
pub(super) const COORDINATES: usize = JointCoordinate::ALL.len();

impl JointCoordinate {
    /// All coordinates.
    pub const ALL: [Self; 6] = [Self::X, Self::Y, Self::Z, Self::Twist, Self::SwingY, Self::SwingZ];
    /// The coordinates of the position.
    pub const TRANSLATIONS: [Self; 3] = [Self::X, Self::Y, Self::Z];
    /// The coordinates of the rotation.
    pub const ROTATIONS: [Self; 3] = [Self::Twist, Self::SwingY, Self::SwingZ];
}
