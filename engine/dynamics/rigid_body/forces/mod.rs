//! Forces, torques, impulses and accelerations that an app applies to dynamic bodies.
//!
//! | | unit | changes the velocity by |
//! |---|---|---|
//! | force F, torque τ | N, N·m | F t / m, I⁻¹ τ t over a time t |
//! | impulse J, angular impulse L | N·s, N·m·s | J / m, I⁻¹ L at once |
//! | acceleration a, angular acceleration α | m/s², rad/s² | a t, α t over a time t, whatever the mass |
//!
//! # For one step
//!
//! [`Forces`] is query data with a method for each of these quantities. Forces and accelerations add up until
//! the next step, act in each substep of that step, and end with it. Apply a lasting force in a schedule that
//! runs once per step, for instance `FixedUpdate`. A force that is applied twice before a step acts twice as
//! much. Ticks without a step, for example while physics is paused, do not add up: only the last of them
//! counts, and only if no force is applied in the tick of the next step. Forces applied within a step, in
//! [`PhysicsSchedule`](crate::schedule::PhysicsSchedule), act in that step if they come before the solver,
//! otherwise in the next step. Impulses change the velocity at once.
//!
//! ```
//! # use avian::{math::Vector, prelude::*};
//! # use bevy_app::prelude::*;
//! # use bevy_ecs::prelude::*;
//! #[derive(Component)]
//! struct Rocket;
//!
//! fn fly(mut rockets: Query<Forces, With<Rocket>>) {
//!     for mut forces in &mut rockets {
//!         // Along the rocket's own axis.
//!         forces.apply_local_force(Vector::Y * 200.0);
//!     }
//! }
//!
//! # let mut app = App::new();
//! app.add_systems(FixedUpdate, fly);
//! ```
//!
//! # Constant forces
//!
//! [`ConstantForce`], [`ConstantTorque`], [`ConstantLocalForce`], [`ConstantLinearAcceleration`],
//! [`ConstantAngularAcceleration`], [`ConstantLocalLinearAcceleration`], and in 3D `ConstantLocalTorque` and
//! `ConstantLocalAngularAcceleration`, act in every step. Inserting, changing or removing one of them wakes
//! the body.
//!
//! # Axes and points
//!
//! *Local* quantities are along the axes of the body and rotate with it in every substep. All others are
//! along the axes of the world. Forces act at the centre of mass, or at a point of the world, where they also
//! cause a torque.
//!
//! # Which bodies respond
//!
//! Only dynamic bodies respond, according to their mass and inertia. Locked axes act as an infinite mass or
//! inertia. Static, kinematic and disabled bodies, and bodies with
//! [`CustomVelocityIntegration`](crate::dynamics::integrator::CustomVelocityIntegration), are not
//! accelerated. A value that is not finite is ignored, with one warning.

mod access;
pub(crate) mod apply;
mod constant;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
pub(crate) mod held;
mod plugin;
mod pushed;
mod query_data;
mod response;

pub use constant::{
    ConstantAngularAcceleration, ConstantForce, ConstantLinearAcceleration, ConstantLocalForce,
    ConstantLocalLinearAcceleration, ConstantTorque,
};
pub use dim::*;
pub use plugin::ForcePlugin;
pub(crate) use pushed::PushedVelocity;
pub use query_data::{
    Forces, ForcesItem, ForcesReadOnly, ForcesReadOnlyItem, NonWakingForcesItem, ReadRigidBodyForces,
    RigidBodyForces, WriteRigidBodyForces,
};

use bevy_ecs::prelude::*;

/// System sets of forces.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ForceSystems {
    /// Accumulated and constant forces are added to the rows of awake bodies. Once per step, in
    /// [`SolverSystems::PrepareSolverBodies`](crate::dynamics::solver::schedule::SolverSystems::PrepareSolverBodies).
    ApplyConstantForces,
    /// Forces in the frame of bodies are applied, once per substep, as part of
    /// [`IntegrationSystems::Velocity`](crate::dynamics::integrator::IntegrationSystems::Velocity).
    ApplyLocalAcceleration,
    /// Accumulated forces are set to zero. Once per step, in
    /// [`SolverSystems::PostSubstep`](crate::dynamics::solver::schedule::SolverSystems::PostSubstep).
    Clear,
}
