//! Gravity, and the system sets of integration.

mod data;
mod plugin;

pub use data::VelocityIntegrationData;
pub use plugin::IntegratorPlugin;

use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::math::Vector;

/// System sets of integration.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum IntegrationSystems {
    /// Gravity, forces and accelerations are converted to velocity increments per substep. Once per step, in
    /// [`SolverSystems::PreSubstep`](crate::dynamics::solver::schedule::SolverSystems::PreSubstep).
    UpdateVelocityIncrements,
    /// Increments and damping are applied to velocities, once per substep.
    Velocity,
    /// Positions are integrated, once per substep.
    Position,
    /// The increments are reset, once per step, in
    /// [`SolverSystems::PostSubstep`](crate::dynamics::solver::schedule::SolverSystems::PostSubstep).
    ClearVelocityIncrements,
}

/// The former name of [`IntegrationSystems`].
#[deprecated(since = "0.4.0", note = "renamed to `IntegrationSystems`")]
pub type IntegrationSet = IntegrationSystems;

/// The gravitational acceleration of dynamic bodies, times their
/// [`GravityScale`](crate::dynamics::rigid_body::GravityScale), in m/s².
///
/// The default is 9.81 m/s² down the Y axis. It is *not* scaled by
/// [`PhysicsLengthUnit`](crate::dynamics::solver::PhysicsLengthUnit): if a metre is 100 pixels, write
/// `Vector::NEG_Y * 981.0`.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_app::App;
/// # let mut app = App::new();
/// app.insert_resource(Gravity(Vector::NEG_Y * 1.62)); // the moon's
/// app.insert_resource(Gravity::ZERO);
/// ```
#[derive(Reflect, Resource, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Resource, Default)]
pub struct Gravity(pub Vector);

impl Default for Gravity {
    fn default() -> Self {
        Self(Vector::NEG_Y * 9.81)
    }
}

impl Gravity {
    /// No gravity.
    pub const ZERO: Gravity = Gravity(Vector::ZERO);
}

/// Leaves the velocity of this body to the app: the engine does not apply gravity, forces, damping or speed
/// limits. Contacts still push the body.
#[derive(Component, Debug, Default, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default)]
pub struct CustomVelocityIntegration;

/// Leaves the position of this body to the app: the velocity does not move the body. Contacts still use the
/// velocity.
///
/// The body counts as at rest, and may fall asleep, while the app does not move it and its velocity is within
/// its [`SleepThreshold`](crate::dynamics::rigid_body::sleeping::SleepThreshold).
#[derive(Component, Debug, Default, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default)]
pub struct CustomPositionIntegration;
