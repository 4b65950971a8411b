//! [`AngularConstraint`] in 2D: angular impulses, applied to rotations.

use super::super::compute_lagrange_update;
use super::turn_by;
use crate::{
    dynamics::solver::solver_body::SolverBody,
    math::{AngularVector, Scalar, SymmetricTensor, Vector3},
};

/// Rotates two bodies by angular impulses.
pub trait AngularConstraint {
    /// Rotates the bodies by the change of a multiplier, in kg·m²·rad. Returns the impulse.
    fn apply_angular_lagrange_update(
        &self,
        body1: &mut SolverBody,
        body2: &mut SolverBody,
        inv_angular_inertia1: SymmetricTensor,
        inv_angular_inertia2: SymmetricTensor,
        delta_lagrange: Scalar,
    ) -> Scalar {
        self.apply_angular_impulse(body1, body2, inv_angular_inertia1, inv_angular_inertia2, delta_lagrange)
    }

    /// Rotates the first body by an impulse in kg·m²·rad, and the second by the opposite impulse. Returns the
    /// impulse.
    fn apply_angular_impulse(
        &self,
        body1: &mut SolverBody,
        body2: &mut SolverBody,
        inv_angular_inertia1: SymmetricTensor,
        inv_angular_inertia2: SymmetricTensor,
        impulse: Scalar,
    ) -> Scalar {
        turn_by(body1, Self::get_delta_rot(inv_angular_inertia1, impulse));
        turn_by(body2, -Self::get_delta_rot(inv_angular_inertia2, impulse));
        impulse
    }

    /// Rotates the bodies to make `angle` zero, the angle of the first body relative to the second in rad.
    /// Returns the change of the multiplier.
    #[expect(clippy::too_many_arguments, reason = "the interface is Avian's")]
    fn align_orientation(
        &self,
        body1: &mut SolverBody,
        body2: &mut SolverBody,
        inv_angular_inertia1: SymmetricTensor,
        inv_angular_inertia2: SymmetricTensor,
        angle: Scalar,
        lagrange: Scalar,
        compliance: Scalar,
        dt: Scalar,
    ) -> AngularVector {
        let inverse = [inv_angular_inertia1, inv_angular_inertia2];
        let update = compute_lagrange_update(lagrange, angle, &inverse, compliance, dt);
        self.apply_angular_impulse(body1, body2, inv_angular_inertia1, inv_angular_inertia2, update)
    }

    /// Rotates the bodies by the change of a multiplier about an axis. Only the axis's z counts. Returns the
    /// impulse.
    fn apply_angular_correction(
        &self,
        body1: &mut SolverBody,
        body2: &mut SolverBody,
        inv_angular_inertia1: SymmetricTensor,
        inv_angular_inertia2: SymmetricTensor,
        delta_lagrange: Scalar,
        axis: Vector3,
    ) -> Scalar {
        let impulse = delta_lagrange * axis.z;
        self.apply_angular_impulse(body1, body2, inv_angular_inertia1, inv_angular_inertia2, impulse)
    }

    /// The angle per impulse about a unit axis, in 1/(kg·m²). Only the axis's z counts.
    fn compute_generalized_inverse_mass(
        &self,
        inv_angular_inertia: SymmetricTensor,
        axis: Vector3,
    ) -> Scalar {
        axis.z * inv_angular_inertia * axis.z
    }

    /// The angle caused by an impulse, in rad.
    fn get_delta_rot(inverse_inertia: SymmetricTensor, p: Scalar) -> Scalar {
        inverse_inertia * p
    }

    /// The torque in N·m of a multiplier in a substep of `dt` seconds.
    fn compute_torque(&self, lagrange: Scalar, dt: Scalar) -> AngularVector {
        lagrange / (dt * dt)
    }
}
