//! Constraints of the app, solved by extended position-based dynamics (XPBD), with the interface of Avian
//! 0.7.
//!
//! The kernel solves the engine's own joints. It can also solve a constraint of the app, by
//! [`Constraint`](super::constraint::Constraint), which is faster and bears higher loads. XPBD is for
//! constraints that were written for Avian, and for constraints that are easier to express as a change of
//! positions.
//!
//! A constraint is a component with [`EntityConstraint`](crate::dynamics::joints::EntityConstraint) and
//! [`XpbdConstraint`], a second component for its [`XpbdConstraintSolverData`], and two systems:
//!
//! ```
//! # use avian::{
//! #     dynamics::{
//! #         joints::EntityConstraint,
//! #         solver::{
//! #             solver_body::{SolverBody, SolverBodyInertia},
//! #             xpbd::*,
//! #         },
//! #     },
//! #     math::{Scalar, Vector},
//! #     prelude::*,
//! # };
//! # use bevy_app::App;
//! # use bevy_ecs::{entity::MapEntities, prelude::*};
//! /// Holds the centres of mass of two bodies at a distance.
//! #[derive(Component, MapEntities)]
//! #[require(RodData)]
//! struct Rod(#[entities] [Entity; 2], Scalar);
//!
//! /// From the second body to the first at the start of the step.
//! #[derive(Component, Default)]
//! struct RodData(Vector, Scalar);
//!
//! impl XpbdConstraintSolverData for RodData {
//!     fn clear_lagrange_multipliers(&mut self) {
//!         self.1 = 0.0;
//!     }
//! }
//!
//! impl EntityConstraint<2> for Rod {
//!     fn entities(&self) -> [Entity; 2] {
//!         self.0
//!     }
//! }
//!
//! impl PositionConstraint for Rod {}
//!
//! impl XpbdConstraint<2> for Rod {
//!     type SolverData = RodData;
//!
//!     fn prepare(&mut self, [a, b]: [&RigidBodyQueryReadOnlyItem; 2], data: &mut RodData) {
//!         let center = |body: &RigidBodyQueryReadOnlyItem| body.position.0 + *body.rotation * body.center_of_mass.0;
//!         data.0 = center(a) - center(b);
//!     }
//!
//!     fn solve(
//!         &mut self,
//!         [a, b]: [&mut SolverBody; 2],
//!         inertias: [&SolverBodyInertia; 2],
//!         data: &mut RodData,
//!         dt: Scalar,
//!     ) {
//!         let offset = data.0 + a.delta_position - b.delta_position;
//!         let n = offset.normalize_or_zero();
//!         let inverse = inertias.map(|inertia| (inertia.effective_inv_mass() * n).dot(n));
//!         let update = compute_lagrange_update(data.1, offset.length() - self.1, &inverse, 0.0, dt);
//!         data.1 += update;
//!         self.apply_positional_impulse(a, b, inertias[0], inertias[1], n * update, Vector::ZERO, Vector::ZERO);
//!     }
//! }
//!
//! fn plugin(app: &mut App) {
//!     app.add_systems(PhysicsSchedule, prepare_xpbd_joint::<Rod>.in_set(SolverSystems::PrepareJoints));
//!     app.add_systems(SubstepSchedule, solve_xpbd_joint::<Rod>.in_set(XpbdSolverSystems::SolveUserConstraints));
//! }
//! # App::new().add_plugins((bevy_transform::TransformPlugin, PhysicsPlugins::default(), plugin));
//! ```
//!
//! Each substep ends at the positions given by the constraints, and velocities follow from the displacement
//! (Müller, Macklin et al., "Detailed Rigid Body Simulation with Extended Position Based Dynamics", 2020).
//! Two bodies with a common constraint are in one island: they sleep and wake together.

#[cfg_attr(feature = "2d", path = "dim2/mod.rs")]
#[cfg_attr(feature = "3d", path = "dim3/mod.rs")]
mod dim;
mod links;
mod plugin;
mod positional_constraint;
mod project;
mod systems;

pub use dim::angular_constraint::AngularConstraint;
pub use plugin::XpbdSolverPlugin;
pub use positional_constraint::PositionConstraint;
pub use systems::{prepare_xpbd_joint, solve_xpbd_joint, warm_start_xpbd_motors};

use bevy_ecs::schedule::SystemSet;

use super::solver_body::{SolverBody, SolverBodyInertia};
use crate::{
    dynamics::rigid_body::RigidBodyQueryReadOnlyItem,
    math::{AngularVector, NO_SPIN, Scalar, Vector},
};

/// System sets of XPBD constraints, in this order, between
/// [`Relax`](super::schedule::SubstepSolverSystems::Relax) and
/// [`Damping`](super::schedule::SubstepSolverSystems::Damping) of
/// [`SubstepSchedule`](super::schedule::SubstepSchedule).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum XpbdSolverSystems {
    /// Joints solved by XPBD. The engine has none.
    SolveConstraints,
    /// Constraints of the app.
    SolveUserConstraints,
    /// Velocities are updated from the displacements caused by constraints.
    VelocityProjection,
}

/// The data of a constraint that persists between the substeps of a step.
pub trait XpbdConstraintSolverData {
    /// Sets the multipliers to zero, at the start of each substep.
    fn clear_lagrange_multipliers(&mut self) {}

    /// The sum of the positional multipliers of a substep, in N·s².
    fn total_position_lagrange(&self) -> Vector {
        Vector::ZERO
    }

    /// The sum of the angular multipliers of a substep, in N·m·s².
    fn total_rotation_lagrange(&self) -> AngularVector {
        NO_SPIN
    }

    /// The sum of the motor's multipliers of a substep, in N·s² or N·m·s².
    fn total_motor_lagrange(&self) -> Scalar {
        0.0
    }
}

/// A constraint between bodies, solved by changing their positions; see the [module](self).
pub trait XpbdConstraint<const ENTITY_COUNT: usize> {
    /// The data that persists between substeps.
    type SolverData: XpbdConstraintSolverData;

    /// Prepares the constraint for a step, before its first substep. The bodies are at their poses at the
    /// start of the step.
    fn prepare(
        &mut self,
        bodies: [&RigidBodyQueryReadOnlyItem; ENTITY_COUNT],
        solver_data: &mut Self::SolverData,
    );

    /// Changes the displacements of the bodies to satisfy the constraint, in a substep of `dt` seconds.
    /// Immovable bodies are [`SolverBody::DUMMY`].
    fn solve(
        &mut self,
        bodies: [&mut SolverBody; ENTITY_COUNT],
        inertias: [&SolverBodyInertia; ENTITY_COUNT],
        solver_data: &mut Self::SolverData,
        dt: Scalar,
    );

    /// Applies the impulses of motors from the last substep to velocities.
    fn warm_start_motors(
        &self,
        _bodies: [&mut SolverBody; ENTITY_COUNT],
        _inertias: [&SolverBodyInertia; ENTITY_COUNT],
        _solver_data: &mut Self::SolverData,
        _dt: Scalar,
        _warm_start_coefficient: Scalar,
    ) {
    }
}

/// The change Δλ of a multiplier λ: Δλ = (−C − α̃ λ) / (Σ wᵢ |∇Cᵢ|² + α̃) with α̃ = α / dt².
///
/// `c` is the error C of the constraint in m or rad, `gradients` its gradients ∇Cᵢ, `inverse_masses` the wᵢ
/// and `compliance` the α in m/N or rad/(N·m). The result is 0 if nothing can move: if the denominator is
/// zero or not finite. Gradients without a mass, and masses without a gradient, are ignored.
pub fn compute_lagrange_update_with_gradients(
    lagrange: Scalar,
    c: Scalar,
    gradients: &[Vector],
    inverse_masses: &[Scalar],
    compliance: Scalar,
    dt: Scalar,
) -> Scalar {
    let weights =
        gradients.iter().zip(inverse_masses).map(|(gradient, inverse)| inverse * gradient.length_squared());
    lagrange_update(lagrange, c, weights.sum(), compliance, dt)
}

/// The same as [`compute_lagrange_update_with_gradients`], for gradients of unit length.
pub fn compute_lagrange_update(
    lagrange: Scalar,
    c: Scalar,
    inverse_masses: &[Scalar],
    compliance: Scalar,
    dt: Scalar,
) -> Scalar {
    lagrange_update(lagrange, c, inverse_masses.iter().sum(), compliance, dt)
}

fn lagrange_update(lagrange: Scalar, c: Scalar, weight: Scalar, compliance: Scalar, dt: Scalar) -> Scalar {
    // Without inverse mass on either side nothing can move, at any softness.
    if !(weight > 0.0) {
        return 0.0;
    }
    let softness = if compliance == 0.0 { 0.0 } else { compliance / (dt * dt) };
    let update = (-c - softness * lagrange) / (weight + softness);
    if update.is_finite() { update } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_update_closes_the_error() {
        // Both bodies move by their share of the error.
        let update = compute_lagrange_update(0.0, 0.3, &[1.0, 0.5], 0.0, 0.01);
        assert!((update + 0.2).abs() < 1e-6);
        let gradients = [Vector::X, Vector::NEG_X];
        let same = compute_lagrange_update_with_gradients(0.0, 0.3, &gradients, &[1.0, 0.5], 0.0, 0.01);
        assert_eq!(update, same);
        // A soft constraint settles at λ = −C / α̃.
        let settled = compute_lagrange_update(-0.3 / 4.0, 0.3, &[1.0], 1.0, 0.5);
        assert!(settled.abs() < 1e-6);
    }

    #[test]
    fn what_cannot_move_is_left() {
        for (c, masses, compliance, dt) in [
            (1.0, &[0.0, 0.0][..], 0.0, 0.01),
            (1.0, &[], 0.0, 0.01),
            (Scalar::NAN, &[1.0], 0.0, 0.01),
            (1.0, &[Scalar::NAN], 0.0, 0.01),
            (1.0, &[1.0], 1.0, 0.0),
        ] {
            assert_eq!(compute_lagrange_update(0.0, c, masses, compliance, dt), 0.0);
        }
    }
}
