//! [`WheelJoint`] in 2D: wheels on springs.

use bevy_ecs::{
    component::Component,
    entity::{Entity, EntityMapper, MapEntities},
    reflect::{ReflectComponent, ReflectMapEntities},
};
use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::{
    math::Rot as KernelRot,
    solver::{
        Axis, JointDef,
        coordinate::{ANGLE, X, Y},
    },
};

use super::super::{
    frame::{JointAnchor, JointBasis, JointFrame, frame_methods},
    kind::{
        EntityConstraint, JointKind, angular_motor, between_two_bodies, limited, linear_motor, own_frames,
    },
    limits::DistanceLimit,
    motor::{AngularMotor, LinearMotor, MotorModel},
    space::{Isometry, Rot, turn_to},
};
use crate::math::{Scalar, Vector};

/// Holds a wheel, the second body, on a chassis, the first. The wheel moves along the suspension axis on a
/// spring, and spins. Beyond Avian.
///
/// The wheel turns about the second anchor. Friction with the ground drives the chassis.
///
/// The spring is a motor along the axis. Its target position is the length of the unloaded spring. With
/// [`MotorModel::SpringDamper`] its stiffness follows from the lighter body, usually the wheel. With
/// [`MotorModel::ForceBased`] the stiffness is given in N/m, and the chassis sags by its weight over the
/// stiffness.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn mount(mut commands: Commands, chassis: Entity, wheel: Entity) {
///     let spring = MotorModel::ForceBased { stiffness: 20_000.0, damping: 2_500.0 };
///     let engine = MotorModel::AccelerationBased { stiffness: 0.0, damping: 10.0 };
///     let joint = WheelJoint::new(chassis, wheel)
///         .with_local_anchor1(Vector::X - Vector::Y * 0.4)
///         .with_suspension(LinearMotor::new(spring))
///         .with_suspension_limits(-0.2, 0.2)
///         .with_motor(AngularMotor::new(engine).with_target_velocity(-20.0).with_max_torque(500.0));
///     commands.spawn((joint, JointCollisionDisabled));
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, MapEntities, PartialEq)]
#[component(map_entities)]
pub struct WheelJoint {
    /// The chassis.
    pub body1: Entity,
    /// The wheel.
    pub body2: Entity,
    /// The frame on the chassis.
    pub frame1: JointFrame,
    /// The frame on the wheel.
    pub frame2: JointFrame,
    /// The direction of the suspension in the joint's frames. Its length does not matter.
    pub suspension_axis: Vector,
    /// The spring along the suspension axis. By default it is critically damped, with 5 Hz.
    pub suspension: LinearMotor,
    /// Minimum and maximum position along the suspension axis, in metres, if any.
    pub suspension_limits: Option<DistanceLimit>,
    /// The motor that spins the wheel. Disabled by default.
    pub motor: AngularMotor,
}

crate::type_path::type_path!(WheelJoint, "dynamics::joints::wheel");

impl WheelJoint {
    /// The y axis.
    pub const DEFAULT_SUSPENSION_AXIS: Vector = Vector::Y;

    /// A wheel at the origin of a chassis, sprung along the y axis.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self {
            body1,
            body2,
            frame1: JointFrame::IDENTITY,
            frame2: JointFrame::IDENTITY,
            suspension_axis: Self::DEFAULT_SUSPENSION_AXIS,
            suspension: LinearMotor::new(MotorModel::DEFAULT),
            suspension_limits: None,
            motor: AngularMotor::new_disabled(MotorModel::DEFAULT),
        }
    }

    /// Sets the direction of the suspension, in the joint's frames.
    pub const fn with_suspension_axis(mut self, axis: Vector) -> Self {
        self.suspension_axis = axis;
        self
    }

    /// Sets the spring. If it is disabled, the wheel moves freely between the limits.
    pub const fn with_suspension(mut self, suspension: LinearMotor) -> Self {
        self.suspension = suspension;
        self
    }

    /// Sets the minimum and maximum position along the suspension axis, in metres.
    pub const fn with_suspension_limits(mut self, min: Scalar, max: Scalar) -> Self {
        self.suspension_limits = Some(DistanceLimit::new(min, max));
        self
    }

    /// Sets the motor that spins the wheel.
    pub const fn with_motor(mut self, motor: AngularMotor) -> Self {
        self.motor = motor;
        self
    }
}

frame_methods!(WheelJoint);
between_two_bodies!(WheelJoint);

impl JointKind for WheelJoint {
    own_frames!();

    fn motor(&self) -> Option<usize> {
        Some(ANGLE)
    }

    fn turn(&self) -> KernelRot {
        turn_to(self.suspension_axis)
    }

    fn set_axes(&self, mut def: JointDef) -> JointDef {
        // The x axis of the frames is the suspension axis.
        def.axes[X] = limited(self.suspension_limits, 0.0);
        def.axes[X].motor = linear_motor(&self.suspension);
        def.axes[ANGLE].motor = angular_motor(&self.motor);
        def.with([Y], Axis::LOCKED)
    }
}
