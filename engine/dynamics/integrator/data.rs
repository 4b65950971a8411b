//! The accelerations of a body that are accumulated for the next step.

use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::math::{AngularVector, Scalar, Vector};

/// Accelerations of a body in world axes, accumulated for the next step.
///
/// [`Forces`](crate::dynamics::rigid_body::forces::Forces) adds to them. An app may also write them directly,
/// which wakes the body. The next step applies them in each of its substeps and sets them to zero at its end.
/// Gravity, damping and constant forces are added by the solver and are not included here.
///
/// ```
/// # use avian::{dynamics::integrator::VelocityIntegrationData, math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// /// Falls towards the origin.
/// fn attract(mut bodies: Query<(&Position, &mut VelocityIntegrationData)>) {
///     for (position, mut data) in &mut bodies {
///         data.apply_linear_acceleration(-10.0 * position.0.normalize_or_zero());
///     }
/// }
/// ```
#[derive(Component, Reflect, Debug, Default, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct VelocityIntegrationData {
    /// Linear acceleration, in m/s².
    pub linear_increment: Vector,
    /// Angular acceleration, in rad/s².
    pub angular_increment: AngularVector,
    /// A factor of linear velocity per substep, for apps that integrate velocities themselves. The engine
    /// itself uses [`LinearDamping`](crate::dynamics::rigid_body::LinearDamping).
    pub linear_damping_rhs: Scalar,
    /// A factor of angular velocity per substep, for apps that integrate velocities themselves. The engine
    /// itself uses [`AngularDamping`](crate::dynamics::rigid_body::AngularDamping).
    pub angular_damping_rhs: Scalar,
}

crate::type_path::type_path!(VelocityIntegrationData, "dynamics::integrator");

impl VelocityIntegrationData {
    /// Adds a linear acceleration in m/s² to the next step.
    pub fn apply_linear_acceleration(&mut self, acceleration: Vector) {
        self.linear_increment += acceleration;
    }

    /// Adds an angular acceleration in rad/s² to the next step.
    pub fn apply_angular_acceleration(&mut self, acceleration: AngularVector) {
        self.angular_increment += acceleration;
    }

    /// Sets the linear factor for a damping coefficient c of `damping_coefficient` 1/s in substeps of h =
    /// `delta_secs` seconds: 1 / (1 + c h).
    pub fn update_linear_damping_rhs(&mut self, damping_coefficient: Scalar, delta_secs: Scalar) {
        self.linear_damping_rhs = 1.0 / (1.0 + damping_coefficient * delta_secs);
    }

    /// Sets the angular factor for a damping coefficient c of `damping_coefficient` 1/s in substeps of h =
    /// `delta_secs` seconds: 1 / (1 + c h).
    pub fn update_angular_damping_rhs(&mut self, damping_coefficient: Scalar, delta_secs: Scalar) {
        self.angular_damping_rhs = 1.0 / (1.0 + damping_coefficient * delta_secs);
    }

    /// Whether there is no acceleration.
    pub(crate) fn is_idle(&self) -> bool {
        self.linear_increment == Vector::ZERO && self.angular_increment == AngularVector::default()
    }
}
