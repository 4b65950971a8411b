//! Rotations and frames of 2D joints. `space3.rs` exports the same names.

use bevy_math::{Isometry2d, Rot2};
use kernel::{
    math as k,
    solver::coordinate::{ANGLE, X, Y},
};

use crate::{
    math::{AdjustPrecision, AngularVector, AsF32, Scalar, Vector, vector_to_kernel},
    physics_transform::Rotation,
};

/// The rotation of a basis.
pub(crate) type Rot = Rotation;
/// A frame in `f32`.
pub(crate) type Isometry = Isometry2d;

/// The coordinates of a position.
pub(super) const TRANSLATIONS: [usize; 2] = [X, Y];
/// The coordinates perpendicular to the x axis.
pub(super) const ACROSS: [usize; 1] = [Y];
/// The coordinates of a rotation.
pub(super) const ROTATIONS: [usize; 1] = [ANGLE];

/// No torque.
pub(super) const NO_TORQUE: AngularVector = 0.0;

/// The magnitude of a torque, in N·m.
pub(super) fn magnitude(torque: AngularVector) -> Scalar {
    torque.abs()
}

/// The rotation of a basis, as a [`Rotation`].
pub(crate) fn rotation_of(basis: Rot) -> Rotation {
    basis
}

/// The basis of a [`Rotation`].
pub(crate) fn basis_of(rotation: Rotation) -> Rot {
    rotation
}

/// Translation and rotation of a frame.
pub(super) fn parts(isometry: Isometry) -> (Vector, Rot) {
    (isometry.translation.adjust_precision(), isometry.rotation.into())
}

/// The frame with a translation and a rotation.
pub(super) fn isometry(translation: Vector, rotation: Rot) -> Isometry {
    Isometry2d::new(translation.f32(), Rot2::from(rotation))
}

/// The rotation that takes the x axis to `axis`. Not finite if `axis` has no direction.
pub(super) fn turn_to(axis: Vector) -> k::Rot {
    let axis = vector_to_kernel(axis.normalize());
    k::Rot { cos: axis.x, sin: axis.y }
}

/// The frame rotation of a joint that turns about an axis. 2D has only one axis.
pub(super) fn turn_about(_axis: Vector) -> k::Rot {
    k::Rot::IDENTITY
}

/// A coordinate of a joint: a position or angle of its second frame relative to its first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JointCoordinate {
    /// Along the first frame's x axis, in m.
    X = X as isize,
    /// Along the first frame's y axis, in m.
    Y = Y as isize,
    /// The angle from the first frame to the second, counter-clockwise, in rad. With limits, full turns are
    /// counted.
    Angle = ANGLE as isize,
}

/// The number of coordinates.
pub(super) const COORDINATES: usize = JointCoordinate::ALL.len();

impl JointCoordinate {
    /// All coordinates.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Angle];
    /// The coordinates of the position.
    pub const TRANSLATIONS: [Self; 2] = [Self::X, Self::Y];
    /// The coordinates of the rotation.
    pub const ROTATIONS: [Self; 1] = [Self::Angle];
}
