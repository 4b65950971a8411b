//! Rotations of bodies by angular impulses in 3D. `dim2` exports the same names.

pub(super) mod angular_constraint;

use crate::{
    dynamics::solver::solver_body::SolverBody,
    math::{AngularVector, Quaternion, Scalar, SymmetricTensor, Vector},
    physics_transform::Rotation,
};

/// A change of a rotation, as a unit quaternion.
pub(super) type AngularDelta = Quaternion;

/// r × p.
pub(super) fn moment(r: Vector, p: Vector) -> AngularVector {
    r.cross(p)
}

/// I⁻¹ L.
pub(super) fn rotation_vector(inverse: SymmetricTensor, impulse: AngularVector) -> AngularVector {
    inverse * impulse
}

/// L · I⁻¹ L.
pub(super) fn inverse_moment(inverse: SymmetricTensor, moment: AngularVector) -> Scalar {
    moment.dot(inverse * moment)
}

/// The unit quaternion of a rotation vector: q = (½ φ, 1) normalised, exact to third order.
pub(super) fn delta_of(vector: AngularVector) -> AngularDelta {
    let half = vector * 0.5;
    let length = (1.0 + half.length_squared()).sqrt();
    Quaternion::from_xyzw(half.x / length, half.y / length, half.z / length, 1.0 / length)
}

/// Rotates a body.
pub(super) fn turn(body: &mut SolverBody, delta: AngularDelta) {
    if delta != Quaternion::IDENTITY {
        body.delta_rotation = Rotation(delta) * body.delta_rotation;
    }
}

/// Rotates a body by a rotation vector.
pub(super) fn turn_by(body: &mut SolverBody, vector: AngularVector) {
    turn(body, delta_of(vector));
}
