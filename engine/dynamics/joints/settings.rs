//! Components beside a joint: what is off, damping, and forces.

use bevy_ecs::{component::Component, reflect::ReflectComponent};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::space::NO_TORQUE;
use crate::math::{AngularVector, Scalar, Vector};

/// Turns the joint of its entity off, as if it were not there.
#[derive(Reflect, Clone, Copy, Component, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default)]
pub struct JointDisabled;

crate::type_path::type_path!(JointDisabled, "dynamics::joints");

/// Lets the two bodies of a joint pass through each other as long as the joint holds them.
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

/// The rate at which the bodies of a joint lose velocity relative to each other, in 1/s. None by default.
///
/// It slows down what the joint leaves free. Momentum is conserved, and kinematic bodies keep their velocity.
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

/// The forces of a joint in the last step. Add the component to have them written.
///
/// All are zero while the joint takes no part in the simulation.
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

    /// The force on the second body along the world's axes, in N. The first body gets the opposite.
    pub const fn force(&self) -> Vector {
        self.force
    }

    /// The torque on the second body about the world's axes, in N·m, besides that of the force at the anchor.
    /// The first body gets the opposite.
    pub const fn torque(&self) -> AngularVector {
        self.torque
    }

    /// The force of the motor in N, or its torque in N·m. Positive if it pushes towards greater positions. Of
    /// a motor that turns about any axis it is the amount. Of gears, racks and pulleys it is the torque or
    /// the force on the first body along its coordinate: negative where a rope pulls.
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
