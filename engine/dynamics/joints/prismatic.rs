//! [`PrismaticJoint`]: sliders.

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
    solver::{JointDef, coordinate::X},
};

use super::{
    frame::{JointAnchor, JointBasis, JointFrame, frame_methods},
    kind::{EntityConstraint, JointKind, between_two_bodies, limited, linear_motor, locked, own_frames},
    limits::DistanceLimit,
    motor::{LinearMotor, MotorModel},
    space::{ACROSS, Isometry, ROTATIONS, Rot, rotation_of, turn_to},
};
use crate::math::{Scalar, Vector};

/// Lets the second body slide along an axis of the first, without turning: doors, lifts, pistons.
///
/// The joint position is the coordinate of the second anchor along the axis, measured from the first anchor.
/// It may have limits and a motor.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn install(mut commands: Commands, shaft: Entity, cabin: Entity) {
///     let lift = PrismaticJoint::new(shaft, cabin).with_slider_axis(Vector::Y).with_limits(0.0, 12.0);
///     commands.spawn((
///         lift.with_motor(LinearMotor::default().with_target_position(4.0).with_max_force(20_000.0)),
///         JointCollisionDisabled,
///     ));
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, MapEntities, PartialEq)]
#[component(map_entities)]
pub struct PrismaticJoint {
    /// The first body.
    pub body1: Entity,
    /// The second body.
    pub body2: Entity,
    /// The frame on the first body.
    pub frame1: JointFrame,
    /// The frame on the second body.
    pub frame2: JointFrame,
    /// The direction of the axis in the joint's frames. Its length does not matter.
    pub slider_axis: Vector,
    /// Minimum and maximum position, if any.
    pub limits: Option<DistanceLimit>,
    /// Compliance of the second anchor perpendicular to the axis, in m/N. 0 is rigid.
    pub align_compliance: Scalar,
    /// Compliance of the bases, in rad/(N·m). 0 is rigid.
    pub angle_compliance: Scalar,
    /// Compliance of the limits, in m/N. 0 is rigid.
    pub limit_compliance: Scalar,
    /// The motor along the axis. Disabled by default.
    pub motor: LinearMotor,
}

impl PrismaticJoint {
    /// The x axis.
    pub const DEFAULT_SLIDER_AXIS: Vector = Vector::X;

    /// A joint along the x axes of two bodies, without limits.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self {
            body1,
            body2,
            frame1: JointFrame::IDENTITY,
            frame2: JointFrame::IDENTITY,
            slider_axis: Self::DEFAULT_SLIDER_AXIS,
            limits: None,
            align_compliance: 0.0,
            angle_compliance: 0.0,
            limit_compliance: 0.0,
            motor: LinearMotor::new_disabled(MotorModel::DEFAULT),
        }
    }

    /// Sets the axis, in the joint's frames.
    pub const fn with_slider_axis(mut self, axis: Vector) -> Self {
        self.slider_axis = axis;
        self
    }

    /// Sets the axis.
    #[deprecated(since = "0.4.0", note = "renamed to `with_slider_axis`")]
    pub const fn with_free_axis(self, axis: Vector) -> Self {
        self.with_slider_axis(axis)
    }

    /// The axis relative to the first body, if its basis is local.
    pub fn local_slider_axis1(&self) -> Option<Vector> {
        Some(rotation_of(self.local_basis1()?) * self.slider_axis)
    }

    /// The axis relative to the second body, if its basis is local.
    pub fn local_slider_axis2(&self) -> Option<Vector> {
        Some(rotation_of(self.local_basis2()?) * self.slider_axis)
    }

    /// Sets the minimum and maximum position, in metres.
    pub const fn with_limits(mut self, min: Scalar, max: Scalar) -> Self {
        self.limits = Some(DistanceLimit::new(min, max));
        self
    }

    /// Sets all compliances.
    #[deprecated(since = "0.4.0", note = "use the methods for single compliances")]
    pub const fn with_compliance(mut self, compliance: Scalar) -> Self {
        self.align_compliance = compliance;
        self.angle_compliance = compliance;
        self.limit_compliance = compliance;
        self
    }

    /// Sets the compliance of the second anchor perpendicular to the axis, in m/N.
    pub const fn with_align_compliance(mut self, compliance: Scalar) -> Self {
        self.align_compliance = compliance;
        self
    }

    /// Sets the compliance of the bases, in rad/(N·m).
    pub const fn with_angle_compliance(mut self, compliance: Scalar) -> Self {
        self.angle_compliance = compliance;
        self
    }

    /// Sets the compliance of the limits, in m/N.
    pub const fn with_limit_compliance(mut self, compliance: Scalar) -> Self {
        self.limit_compliance = compliance;
        self
    }

    /// Sets the motor.
    pub const fn with_motor(mut self, motor: LinearMotor) -> Self {
        self.motor = motor;
        self
    }
}

frame_methods!(PrismaticJoint);
between_two_bodies!(PrismaticJoint);

impl JointKind for PrismaticJoint {
    own_frames!();

    fn motor(&self) -> Option<usize> {
        Some(X)
    }

    fn turn(&self) -> KernelRot {
        turn_to(self.slider_axis)
    }

    fn set_axes(&self, mut def: JointDef) -> JointDef {
        def.axes[X] = limited(self.limits, self.limit_compliance);
        def.axes[X].motor = linear_motor(&self.motor);
        def.with(ACROSS, locked(self.align_compliance)).with(ROTATIONS, locked(self.angle_compliance))
    }
}
