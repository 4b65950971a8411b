//! Rotations of bodies by angular impulses in 2D. `dim3` exports the same names.

pub(super) mod angular_constraint;

use crate::{
    dynamics::solver::solver_body::SolverBody,
    math::{AngularVector, Scalar, SymmetricTensor, Vector},
    physics_transform::Rotation,
};

/// A change of a rotation: an angle in rad.
pub(super) type AngularDelta = Scalar;

/// r × p.
pub(super) fn moment(r: Vector, p: Vector) -> AngularVector {
    r.perp_dot(p)
}

/// I⁻¹ L.
pub(super) fn rotation_vector(inverse: SymmetricTensor, impulse: AngularVector) -> AngularVector {
    inverse * impulse
}

/// L · I⁻¹ L.
pub(super) fn inverse_moment(inverse: SymmetricTensor, moment: AngularVector) -> Scalar {
    moment * inverse * moment
}

/// The change of rotation given by a rotation vector.
pub(super) fn delta_of(vector: AngularVector) -> AngularDelta {
    vector
}

/// Rotates a body.
pub(super) fn turn(body: &mut SolverBody, delta: AngularDelta) {
    if delta != 0.0 {
        body.delta_rotation = Rotation::radians(delta) * body.delta_rotation;
    }
}

/// Rotates a body by a rotation vector.
pub(super) fn turn_by(body: &mut SolverBody, vector: AngularVector) {
    turn(body, vector);
}
