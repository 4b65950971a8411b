//! [`AngularConstraint`] in 3D: angular impulses, applied to rotations.

use super::super::compute_lagrange_update;
use super::{delta_of, rotation_vector, turn_by};
use crate::{
    dynamics::solver::solver_body::SolverBody,
    math::{AngularVector, Quaternion, Scalar, SymmetricTensor, Vector, Vector3},
};

/// Rotates two bodies by angular impulses. Inertias and axes are in world axes.
pub trait AngularConstraint {
    /// Rotates the bodies by the change of a multiplier, in kg·m²·rad, about a unit axis. Returns the
    /// impulse.
    fn apply_angular_lagrange_update(
        &self,
        body1: &mut SolverBody,
        body2: &mut SolverBody,
        inv_angular_inertia1: SymmetricTensor,
        inv_angular_inertia2: SymmetricTensor,
        delta_lagrange: Scalar,
        axis: Vector,
    ) -> Vector {
        let impulse = axis * delta_lagrange;
        self.apply_angular_impulse(body1, body2, inv_angular_inertia1, inv_angular_inertia2, impulse)
    }

    /// Rotates the first body by an impulse in kg·m²·rad, and the second by the opposite impulse. Returns the
    /// impulse.
    fn apply_angular_impulse(
        &self,
        body1: &mut SolverBody,
        body2: &mut SolverBody,
        inv_angular_inertia1: SymmetricTensor,
        inv_angular_inertia2: SymmetricTensor,
        impulse: Vector,
    ) -> Vector {
        turn_by(body1, rotation_vector(inv_angular_inertia1, impulse));
        turn_by(body2, rotation_vector(inv_angular_inertia2, -impulse));
        impulse
    }

    /// Rotates the bodies to make `rotation_difference` zero, the rotation vector of the first body relative
    /// to the second in rad. Returns the change of the multiplier along its axis.
    #[expect(clippy::too_many_arguments, reason = "the interface is Avian's")]
    fn align_orientation(
        &self,
        body1: &mut SolverBody,
        body2: &mut SolverBody,
        inv_angular_inertia1: SymmetricTensor,
        inv_angular_inertia2: SymmetricTensor,
        rotation_difference: Vector,
        lagrange: Scalar,
        compliance: Scalar,
        dt: Scalar,
    ) -> AngularVector {
        let angle = rotation_difference.length();
        let Some(axis) = rotation_difference.try_normalize() else { return Vector::ZERO };
        let inverse = [inv_angular_inertia1, inv_angular_inertia2]
            .map(|inertia| AngularConstraint::compute_generalized_inverse_mass(self, inertia, axis));
        let update = compute_lagrange_update(lagrange, angle, &inverse, compliance, dt);
        let (inverse1, inverse2) = (inv_angular_inertia1, inv_angular_inertia2);
        self.apply_angular_lagrange_update(body1, body2, inverse1, inverse2, update, axis)
    }

    /// The same as [`apply_angular_lagrange_update`](Self::apply_angular_lagrange_update).
    fn apply_angular_correction(
        &self,
        body1: &mut SolverBody,
        body2: &mut SolverBody,
        inv_angular_inertia1: SymmetricTensor,
        inv_angular_inertia2: SymmetricTensor,
        delta_lagrange: Scalar,
        axis: Vector,
    ) -> Vector {
        let (inverse1, inverse2) = (inv_angular_inertia1, inv_angular_inertia2);
        self.apply_angular_lagrange_update(body1, body2, inverse1, inverse2, delta_lagrange, axis)
    }

    /// The angle per impulse about a unit axis, in 1/(kg·m²).
    fn compute_generalized_inverse_mass(
        &self,
        inv_angular_inertia: SymmetricTensor,
        axis: Vector3,
    ) -> Scalar {
        axis.dot(inv_angular_inertia * axis)
    }

    /// The rotation caused by an impulse.
    fn get_delta_rot(inverse_inertia: SymmetricTensor, p: Vector) -> Quaternion {
        delta_of(rotation_vector(inverse_inertia, p))
    }

    /// The torque in N·m of a multiplier about an axis in a substep of `dt` seconds.
    fn compute_torque(&self, lagrange: Scalar, axis: Vector, dt: Scalar) -> AngularVector {
        axis * (lagrange / (dt * dt))
    }
}
