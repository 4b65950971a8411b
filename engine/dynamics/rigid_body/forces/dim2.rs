//! Forces of 2D. `dim3.rs` exports the same names, and the torques in the body's frame, which 2D does not
//! need: a torque is the same in all frames of the plane.

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::constant::{
    ConstantAngularAcceleration, ConstantForce, ConstantLinearAcceleration, ConstantLocalForce,
    ConstantLocalLinearAcceleration, ConstantTorque,
};
use crate::{
    math::{AngularVector, Scalar, Vector},
    physics_transform::Rotation,
};

/// Acceleration in a body's own frame, summed up for the next step, in which it turns with the body.
/// [`Forces`](super::Forces) adds to it. It is zero again at the end of the step.
///
/// An app may write it by hand. That alone does not wake a sleeping body.
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
}

crate::type_path::type_path!(AccumulatedLocalAcceleration, "dynamics::rigid_body::forces");

impl AccumulatedLocalAcceleration {
    /// The angular acceleration in the body's frame: always zero in 2D.
    pub(crate) fn local_angular(&self) -> AngularVector {
        0.0
    }

    /// The angular acceleration in world axes: always zero in 2D.
    pub(super) fn world_angular(&self, _rotation: &Rotation) -> AngularVector {
        0.0
    }

    /// Nothing to reset in 2D.
    pub(super) fn reset_angular(&mut self) {}

    /// Nothing to subtract in 2D.
    pub(super) fn subtract_angular(&mut self, _other: &Self) {}
}

/// Declares the methods of `WriteRigidBodyForces` for torques in the body's frame: none in 2D.
macro_rules! local_torque_methods {
    () => {};
}

pub(super) use local_torque_methods;

/// Constant torques in the body's frame: none in 2D. The entity stands in for them, as every body has one.
pub(super) type LocalTorques = Entity;

/// Torque and angular acceleration in the body's frame.
pub(super) fn local_torques(_torques: &Entity) -> (AngularVector, AngularVector) {
    (0.0, 0.0)
}

/// A torque in world axes.
pub(super) fn to_world(_rotation: &Rotation, torque: AngularVector) -> AngularVector {
    torque
}

/// A torque in the body's frame.
pub(super) fn to_body(_rotation: &Rotation, torque: AngularVector) -> AngularVector {
    torque
}

/// All components of constant forces.
pub(super) type Constants = (
    ConstantForce,
    ConstantTorque,
    ConstantLocalForce,
    ConstantLinearAcceleration,
    ConstantAngularAcceleration,
    ConstantLocalLinearAcceleration,
);

/// The filter for bodies with a constant force.
pub(super) type HasConstant = Or<(
    With<ConstantForce>,
    With<ConstantTorque>,
    With<ConstantLocalForce>,
    With<ConstantLinearAcceleration>,
    With<ConstantAngularAcceleration>,
    With<ConstantLocalLinearAcceleration>,
)>;

/// The filter for bodies whose constant force changed.
pub(super) type ChangedConstant = Or<(
    Changed<ConstantForce>,
    Changed<ConstantTorque>,
    Changed<ConstantLocalForce>,
    Changed<ConstantLinearAcceleration>,
    Changed<ConstantAngularAcceleration>,
    Changed<ConstantLocalLinearAcceleration>,
)>;

/// Registers the types of this file for reflection.
pub(crate) fn register_types(app: &mut App) {
    app.register_type::<AccumulatedLocalAcceleration>();
}

/// Constructors from components.
macro_rules! from_xy {
    ($($type:ident),+) => {$(
        impl $type {
            /// The same as from a [`Vector`], by components.
            pub fn new(x: Scalar, y: Scalar) -> Self {
                Self(Vector::new(x, y))
            }
        }
    )+};
}

from_xy!(ConstantForce, ConstantLocalForce, ConstantLinearAcceleration, ConstantLocalLinearAcceleration);
