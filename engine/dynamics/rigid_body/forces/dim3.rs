//! Forces of 3D: the names of `dim2.rs`, and torques in the body's frame.

use bevy_app::App;
use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::constant::{
    ConstantAngularAcceleration, ConstantForce, ConstantLinearAcceleration, ConstantLocalForce,
    ConstantLocalLinearAcceleration, ConstantTorque,
};
use super::pushed::Quantity;
use crate::{
    math::{AngularVector, Scalar, Vector},
    physics_transform::Rotation,
};

/// Acceleration in a body's own frame, accumulated for the next step. It rotates with the body during that
/// step. [`Forces`](super::Forces) adds to it, and the engine sets it to zero at the end of the step.
///
/// An app may write it directly. That alone does not wake a sleeping body.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct AccumulatedLocalAcceleration {
    /// Acceleration along the body's axes, in m/s².
    pub linear: Vector,
    /// Angular acceleration about the body's axes, in rad/s².
    pub angular: Vector,
}

crate::type_path::type_path!(AccumulatedLocalAcceleration, "dynamics::rigid_body::forces");

impl AccumulatedLocalAcceleration {
    /// The angular acceleration in the body's frame.
    pub(crate) fn local_angular(&self) -> AngularVector {
        self.angular
    }

    /// The angular acceleration in world axes.
    pub(super) fn world_angular(&self, rotation: &Rotation) -> AngularVector {
        rotation * self.angular
    }

    /// Sets the angular acceleration to zero.
    pub(super) fn reset_angular(&mut self) {
        self.angular = Vector::ZERO;
    }

    /// Subtracts the angular acceleration of `other`.
    pub(super) fn subtract_angular(&mut self, other: &Self) {
        self.angular = self.angular.less(other.angular);
    }
}

/// A constant torque on a dynamic body, in N·m about the body's own axes. It rotates with the body. See
/// [`ConstantForce`].
#[derive(Component, Reflect, Clone, Debug, Default, Deref, DerefMut, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ConstantLocalTorque(pub AngularVector);

crate::type_path::type_path!(ConstantLocalTorque, "dynamics::rigid_body::forces");

/// A constant angular acceleration of a dynamic body, in rad/s² about the body's own axes, independent of the
/// inertia. It rotates with the body. See [`ConstantForce`].
#[derive(Component, Reflect, Clone, Debug, Default, Deref, DerefMut, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ConstantLocalAngularAcceleration(pub AngularVector);

crate::type_path::type_path!(ConstantLocalAngularAcceleration, "dynamics::rigid_body::forces");

/// Declares the methods of `WriteRigidBodyForces` for torques in the body's frame.
macro_rules! local_torque_methods {
    () => {
        /// Applies a torque about the body's own axes, in N·m. It rotates with the body during the step.
        fn apply_local_torque(&mut self, torque: AngularVector) {
            let seen = self.seen();
            let acceleration = seen.rotation.inverse() * seen.angular_response(seen.rotation * torque);
            accumulate(self, "torque", |to| &mut to.local.angular, acceleration);
        }

        /// Applies an angular impulse about the body's own axes, in N·m·s. The angular velocity changes at
        /// once.
        fn apply_local_angular_impulse(&mut self, impulse: AngularVector) {
            let impulse = self.seen().rotation * impulse;
            self.apply_angular_impulse(impulse);
        }

        /// Applies an angular acceleration about the body's own axes, in rad/s², independent of the inertia.
        /// It rotates with the body during the step.
        fn apply_local_angular_acceleration(&mut self, acceleration: AngularVector) {
            accumulate(self, "angular acceleration", |to| &mut to.local.angular, acceleration);
        }
    };
}

pub(super) use local_torque_methods;

/// Constant torques in the body's frame.
pub(super) type LocalTorques =
    (Option<&'static ConstantLocalTorque>, Option<&'static ConstantLocalAngularAcceleration>);

/// The torque and angular acceleration in the body's frame.
pub(super) fn local_torques(
    (torque, acceleration): &(Option<&ConstantLocalTorque>, Option<&ConstantLocalAngularAcceleration>),
) -> (AngularVector, AngularVector) {
    (torque.map_or(Vector::ZERO, |torque| torque.0), acceleration.map_or(Vector::ZERO, |turn| turn.0))
}

/// Converts a torque in the body's frame to world axes.
pub(super) fn to_world(rotation: &Rotation, torque: AngularVector) -> AngularVector {
    rotation * torque
}

/// Converts a torque in world axes to the body's frame.
pub(super) fn to_body(rotation: &Rotation, torque: AngularVector) -> AngularVector {
    rotation.inverse() * torque
}

/// All components of constant forces.
pub(super) type Constants = (
    ConstantForce,
    ConstantTorque,
    ConstantLocalForce,
    ConstantLocalTorque,
    ConstantLinearAcceleration,
    ConstantAngularAcceleration,
    ConstantLocalLinearAcceleration,
    ConstantLocalAngularAcceleration,
);

/// The filter for bodies with a constant force.
pub(super) type HasConstant = Or<(
    With<ConstantForce>,
    With<ConstantTorque>,
    With<ConstantLocalForce>,
    With<ConstantLocalTorque>,
    With<ConstantLinearAcceleration>,
    With<ConstantAngularAcceleration>,
    With<ConstantLocalLinearAcceleration>,
    With<ConstantLocalAngularAcceleration>,
)>;

/// The filter for bodies whose constant force changed.
pub(super) type ChangedConstant = Or<(
    Changed<ConstantForce>,
    Changed<ConstantTorque>,
    Changed<ConstantLocalForce>,
    Changed<ConstantLocalTorque>,
    Changed<ConstantLinearAcceleration>,
    Changed<ConstantAngularAcceleration>,
    Changed<ConstantLocalLinearAcceleration>,
    Changed<ConstantLocalAngularAcceleration>,
)>;

/// Registers the types of this file for reflection.
pub(crate) fn register_types(app: &mut App) {
    app.register_type::<AccumulatedLocalAcceleration>()
        .register_type::<ConstantLocalTorque>()
        .register_type::<ConstantLocalAngularAcceleration>();
}

/// Defines constructors from components.
macro_rules! from_xyz {
    ($($type:ident),+) => {$(
        impl $type {
            /// Like the constructor from a [`Vector`], with components.
            pub fn new(x: Scalar, y: Scalar, z: Scalar) -> Self {
                Self(Vector::new(x, y, z))
            }
        }
    )+};
}

from_xyz!(
    ConstantForce,
    ConstantTorque,
    ConstantLocalForce,
    ConstantLocalTorque,
    ConstantLinearAcceleration,
    ConstantAngularAcceleration,
    ConstantLocalLinearAcceleration,
    ConstantLocalAngularAcceleration
);
