//! [`WheelJoint`] in 3D: wheels on springs.

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
        coordinate::{SWING_Y, SWING_Z, TWIST, X, Y, Z},
    },
};

use super::super::{
    frame::{JointAnchor, JointBasis, JointFrame, frame_methods},
    kind::{
        EntityConstraint, JointKind, angular_motor, between_two_bodies, limited, linear_motor, own_frames,
    },
    limits::{AngleLimit, DistanceLimit},
    motor::{AngularMotor, LinearMotor, MotorModel},
    space::{Isometry, Rot, turn_to_plane},
};
use crate::math::{Scalar, Vector};

/// Holds a wheel, the second body, on a chassis, the first. The wheel moves along the suspension axis on a
/// spring, and spins. Beyond Avian.
///
/// The wheel spins about its axle. The steering motor turns the axle about the suspension axis to its target
/// angle. While the steering motor is disabled, the steering angle is locked at 0.
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
    /// The direction of the suspension in the joint's frames. The component along the axle is ignored, and
    /// the length does not matter.
    pub suspension_axis: Vector,
    /// The direction of the axle in the joint's frames. Its length does not matter.
    pub axle: Vector,
    /// The spring along the suspension axis. By default it is critically damped, with 5 Hz.
    pub suspension: LinearMotor,
    /// Minimum and maximum position along the suspension axis, in metres, if any.
    pub suspension_limits: Option<DistanceLimit>,
    /// The steering motor, which turns the axle about the suspension axis, right-handed. Disabled by default.
    pub steering: AngularMotor,
    /// Minimum and maximum steering angle in radians, if any. They apply while the steering motor is enabled.
    pub steering_limits: Option<AngleLimit>,
    /// The motor that spins the wheel. Disabled by default.
    pub motor: AngularMotor,
}

crate::type_path::type_path!(WheelJoint, "dynamics::joints::wheel");

impl WheelJoint {
    /// The y axis.
    pub const DEFAULT_SUSPENSION_AXIS: Vector = Vector::Y;
    /// The x axis.
    pub const DEFAULT_AXLE: Vector = Vector::X;

    /// A wheel at the origin of a chassis. Its spring is along the y axis, and its axle along the x axis.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self {
            body1,
            body2,
            frame1: JointFrame::IDENTITY,
            frame2: JointFrame::IDENTITY,
            suspension_axis: Self::DEFAULT_SUSPENSION_AXIS,
            axle: Self::DEFAULT_AXLE,
            suspension: LinearMotor::new(MotorModel::DEFAULT),
            suspension_limits: None,
            steering: AngularMotor::new_disabled(MotorModel::DEFAULT),
            steering_limits: None,
            motor: AngularMotor::new_disabled(MotorModel::DEFAULT),
        }
    }

    /// Sets the direction of the suspension, in the joint's frames.
    pub const fn with_suspension_axis(mut self, axis: Vector) -> Self {
        self.suspension_axis = axis;
        self
    }

    /// Sets the direction of the axle, in the joint's frames.
    pub const fn with_axle(mut self, axle: Vector) -> Self {
        self.axle = axle;
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

    /// Sets the steering motor.
    pub const fn with_steering(mut self, steering: AngularMotor) -> Self {
        self.steering = steering;
        self
    }

    /// Sets the minimum and maximum steering angle, in radians.
    pub const fn with_steering_limits(mut self, min: Scalar, max: Scalar) -> Self {
        self.steering_limits = Some(AngleLimit::new(min, max));
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
        Some(TWIST)
    }

    fn turn(&self) -> KernelRot {
        turn_to_plane(self.axle, self.suspension_axis)
    }

    fn set_axes(&self, mut def: JointDef) -> JointDef {
        // The x axis of the frames is the axle, the y axis is the suspension axis.
        def.axes[Y] = limited(self.suspension_limits, 0.0);
        def.axes[Y].motor = linear_motor(&self.suspension);
        def.axes[TWIST].motor = angular_motor(&self.motor);
        def.axes[SWING_Y] = match angular_motor(&self.steering) {
            None => Axis::LOCKED,
            motor => Axis { motor, ..limited(self.steering_limits, 0.0) },
        };
        def.with([X, Z, SWING_Z], Axis::LOCKED)
    }
}
