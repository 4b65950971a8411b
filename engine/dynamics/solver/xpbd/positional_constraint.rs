//! [`PositionConstraint`]: impulses at points, applied to positions.

use super::dim::{self, AngularDelta};
use crate::{
    dynamics::solver::solver_body::{SolverBody, SolverBodyInertia},
    math::{Scalar, SymmetricTensor, Vector},
};

/// Moves two bodies by impulses at points of the bodies.
///
/// `r1` and `r2` are the vectors in m from the bodies' centres of mass to the points, along the world's axes.
pub trait PositionConstraint {
    /// Moves and rotates the first body by an impulse in kg·m at `r1`, and the second by the opposite impulse
    /// at `r2`.
    #[expect(clippy::too_many_arguments, reason = "the interface is Avian's")]
    fn apply_positional_impulse(
        &self,
        body1: &mut SolverBody,
        body2: &mut SolverBody,
        inertia1: &SolverBodyInertia,
        inertia2: &SolverBodyInertia,
        impulse: Vector,
        r1: Vector,
        r2: Vector,
    ) {
        for (body, inertia, impulse, r) in [(body1, inertia1, impulse, r1), (body2, inertia2, -impulse, r2)] {
            body.delta_position += inertia.effective_inv_mass() * impulse;
            let delta = Self::get_delta_rot(inertia.effective_inv_angular_inertia(), r, impulse);
            dim::turn(body, delta);
        }
    }

    /// The inverse effective mass in 1/kg: the displacement of the point at `r` along the unit vector `n` per
    /// impulse along `n`, 1/m + (r × n) · I⁻¹ (r × n).
    fn compute_generalized_inverse_mass(
        &self,
        inverse_mass: Scalar,
        inverse_angular_inertia: SymmetricTensor,
        r: Vector,
        n: Vector,
    ) -> Scalar {
        inverse_mass + dim::inverse_moment(inverse_angular_inertia, dim::moment(r, n))
    }

    /// The rotation caused by an impulse `p` in kg·m at `r`: in 2D an angle in rad, in 3D a unit quaternion.
    fn get_delta_rot(inverse_angular_inertia: SymmetricTensor, r: Vector, p: Vector) -> AngularDelta {
        dim::delta_of(dim::rotation_vector(inverse_angular_inertia, dim::moment(r, p)))
    }

    /// The force in N of a multiplier along a direction in a substep of `dt` seconds.
    fn compute_force(&self, lagrange: Scalar, direction: Vector, dt: Scalar) -> Vector {
        direction * (lagrange / (dt * dt))
    }
}
