//! Optional components of a joint entity: disabling, damping, and forces.

use bevy_ecs::{component::Component, reflect::ReflectComponent};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::space::NO_TORQUE;
use crate::math::{AngularVector, Scalar, Vector};

/// Disables the joint of its entity, as if the joint did not exist.
#[derive(Reflect, Clone, Copy, Component, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default)]
pub struct JointDisabled;

crate::type_path::type_path!(JointDisabled, "dynamics::joints");

/// Disables collisions between the two bodies of a joint while the joint acts.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn hinge(mut commands: Commands, arm: Entity, hand: Entity) {
///     commands.spawn((RevoluteJoint::new(arm, hand), JointCollisionDisabled));
/// }
/// ```
#[derive(Component, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
pub struct JointCollisionDisabled;

crate::type_path::type_path!(JointCollisionDisabled, "dynamics::joints");

/// Damping of the relative velocity of a joint's bodies, in 1/s. 0 by default.
///
/// It damps the free axes of the joint. Momentum is conserved, and kinematic bodies keep their velocity.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
pub struct JointDamping {
    /// Rate of the linear velocity.
    pub linear: Scalar,
    /// Rate of the angular velocity.
    pub angular: Scalar,
}

crate::type_path::type_path!(JointDamping, "dynamics::joints");

/// The forces of a joint in the last step. Add the component to request them.
///
/// All forces are zero while the joint is not in the simulation.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn tear(ropes: Query<(Entity, &JointForces), With<DistanceJoint>>, mut commands: Commands) {
///     for (rope, forces) in &ropes {
///         if forces.force().length() > 500.0 {
///             commands.entity(rope).despawn();
///         }
///     }
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
pub struct JointForces {
    force: Vector,
    torque: AngularVector,
    motor_force: Scalar,
}

crate::type_path::type_path!(JointForces, "dynamics::joints");

impl JointForces {
    /// No forces.
    pub const fn new() -> Self {
        Self { force: Vector::ZERO, torque: NO_TORQUE, motor_force: 0.0 }
    }

    /// The force on the second body along the world's axes, in N. The force on the first body is opposite.
    pub const fn force(&self) -> Vector {
        self.force
    }

    /// The torque on the second body about the world's axes, in N·m, excluding the torque of the force at the
    /// anchor. The torque on the first body is opposite.
    pub const fn torque(&self) -> AngularVector {
        self.torque
    }

    /// The motor's force in N, or its torque in N·m. It is positive if the motor pushes towards larger
    /// positions. For a motor that turns about any axis it is the magnitude of the torque. For gears, racks
    /// and pulleys it is the torque or force on the first body along its coordinate: negative where a rope
    /// pulls.
    pub const fn motor_force(&self) -> Scalar {
        self.motor_force
    }

    /// Overwrites the force. The next step writes it again.
    pub const fn set_force(&mut self, force: Vector) {
        self.force = force;
    }

    /// Overwrites the torque. The next step writes it again.
    pub const fn set_torque(&mut self, torque: AngularVector) {
        self.torque = torque;
    }

    /// Overwrites the motor's force. The next step writes it again.
    pub const fn set_motor_force(&mut self, motor_force: Scalar) {
        self.motor_force = motor_force;
    }
}
