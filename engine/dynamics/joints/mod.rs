//! Joints: constraints on the relative motion of two bodies.
//!
//! A joint is an entity with one of these components:
//!
//! | Component | Leaves free |
//! | --- | --- |
//! | [`FixedJoint`] | nothing |
//! | [`DistanceJoint`] | everything within a range of distances of two points |
//! | [`PrismaticJoint`] | a movement along an axis, with limits and a motor |
//! | [`RevoluteJoint`] | a turn about a point (2D) or an axis (3D), with limits and a motor |
//! | [`GenericJoint`] | what its axes say |
//! | [`WheelJoint`] | a movement along an axis by a spring, and a spin with a motor; in 3D steering |
//! | [`GearJoint`], [`RackAndPinionJoint`] | turns and ways of two bodies that are tied to each other |
//! | [`PulleyJoint`] | everything, on a rope over two pulleys |
//! | [`MouseJoint`] | everything: it pulls a body to the pose of its entity |
//! | `SphericalJoint` (3D) | all turns about a point, with limits of swing and twist |
//!
//! The entity may also have [`JointDisabled`], [`JointCollisionDisabled`], [`JointDamping`], [`JointForces`],
//! [`JointError`] and [`JointBreakThreshold`]. [`JointSolver`] selects the solver for all joints.
//!
//! ```
//! # use avian::{math::Vector, prelude::*};
//! # use bevy_ecs::prelude::*;
//! fn pendulum(mut commands: Commands) {
//!     let hook = commands.spawn(RigidBody::Static).id();
//!     let bob = commands.spawn((RigidBody::Dynamic, Collider::capsule(0.2, 0.1), Position(Vector::X * 2.0))).id();
//!     // At the hook, two metres from the bob.
//!     commands.spawn(RevoluteJoint::new(hook, bob).with_anchor(Vector::ZERO));
//! }
//! ```
//!
//! A joint acts while both its entities are bodies in the simulation, in whatever order the joint and the
//! bodies were spawned. Its fields may change at any time, including the bodies. A joint that cannot act,
//! because both bodies are the same or its numbers are not finite, is reported once, and acts as soon as it
//! can. The bodies of a joint are in one island: they sleep and wake together.
//!
//! # Compliance
//!
//! A compliance of 0 is rigid: the joint gives way as little as the substeps resolve. A joint with compliance
//! α gives way by α times the force or torque: it is a spring of stiffness 1/α, without damping.
//! [`JointDamping`] damps it.

mod axis;
mod breaking;
mod changes;
pub(crate) mod coupling;
#[cfg_attr(feature = "2d", path = "dim2/mod.rs")]
#[cfg_attr(feature = "3d", path = "dim3/mod.rs")]
pub(crate) mod dim;
mod distance;
pub(crate) mod error;
mod fixed;
pub(crate) mod forces;
mod frame;
mod generic;
pub(crate) mod kind;
mod kinds;
mod laws;
pub(crate) mod lifecycle;
mod limits;
mod motor;
mod mouse;
mod plugin;
mod prismatic;
mod pulley;
mod settings;
pub(crate) mod settle;
mod solver;
#[cfg_attr(feature = "2d", path = "space2.rs")]
#[cfg_attr(feature = "3d", path = "space3.rs")]
pub(crate) mod space;
pub(crate) mod table;
#[cfg(test)]
mod tests;

pub use axis::{AxisSpring, JointAxis, JointSoftness};
pub use breaking::{JointBreakThreshold, JointBroken};
pub use dim::*;
pub use distance::DistanceJoint;
pub use error::JointError;
pub use fixed::FixedJoint;
pub use frame::{JointAnchor, JointBasis, JointFrame};
pub use generic::GenericJoint;
pub use kind::EntityConstraint;
pub use limits::{AngleLimit, DistanceLimit};
pub use motor::{AngularMotor, AxisMotor, LinearMotor, MotorModel};
pub use mouse::MouseJoint;
pub use plugin::JointPlugin;
pub use prismatic::PrismaticJoint;
pub use pulley::PulleyJoint;
pub use settings::{JointCollisionDisabled, JointDamping, JointDisabled, JointForces};
pub use solver::JointSolver;
pub use space::JointCoordinate;

use bevy_ecs::schedule::SystemSet;

/// System sets of joints.
#[derive(SystemSet, Clone, Debug, Hash, PartialEq, Eq)]
pub enum JointSystems {
    /// Between
    /// [`SolverSystems::PrepareSolverBodies`](super::solver::schedule::SolverSystems::PrepareSolverBodies)
    /// and [`SolverSystems::PrepareJoints`](super::solver::schedule::SolverSystems::PrepareJoints). Frames
    /// are already local: they are computed at the start of the step, where joints enter.
    PrepareLocalFrames,
}
