//! Forces of 2D. `dim3.rs` exports the same names, and additionally torques in the body's frame. 2D does not
//! need these, because a torque is the same in all frames of the plane.

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

/// Declares the methods of `WriteRigidBodyForces` for torques in the body's frame. 2D has none.
macro_rules! local_torque_methods {
    () => {};
}

pub(super) use local_torque_methods;

/// Constant torques in the body's frame. 2D has none, and `Entity` is the placeholder, because every body has
/// one.
pub(super) type LocalTorques = Entity;

/// The torque and angular acceleration in the body's frame.
pub(super) fn local_torques(_torques: &Entity) -> (AngularVector, AngularVector) {
    (0.0, 0.0)
}

/// Converts a torque in the body's frame to world axes.
pub(super) fn to_world(_rotation: &Rotation, torque: AngularVector) -> AngularVector {
    torque
}

/// Converts a torque in world axes to the body's frame.
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

/// Defines constructors from components.
macro_rules! from_xy {
    ($($type:ident),+) => {$(
        impl $type {
            /// Like the constructor from a [`Vector`], with components.
            pub fn new(x: Scalar, y: Scalar) -> Self {
                Self(Vector::new(x, y))
            }
        }
    )+};
}

from_xy!(ConstantForce, ConstantLocalForce, ConstantLinearAcceleration, ConstantLocalLinearAcceleration);
