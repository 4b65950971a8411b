//! [`RevoluteJoint`] in 2D: pins, wheels and hinges.

use bevy_ecs::{
    component::Component,
    entity::{Entity, EntityMapper, MapEntities},
    reflect::{ReflectComponent, ReflectMapEntities},
};
use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::solver::{JointDef, coordinate::ANGLE};

use super::super::{
    frame::{JointAnchor, JointBasis, JointFrame, frame_methods},
    kind::{EntityConstraint, JointKind, angular_motor, between_two_bodies, limited, locked, own_frames},
    limits::AngleLimit,
    motor::{AngularMotor, MotorModel},
    space::{Isometry, Rot, TRANSLATIONS},
};
use crate::math::{Scalar, Vector};

/// Holds a point of one body at a point of another and lets the bodies turn about it: pins, wheels, hinges.
///
/// The joint angle is measured from the first basis to the second, counter-clockwise. It may have limits,
/// even beyond a full turn, and a motor.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn mount(mut commands: Commands, car: Entity, wheel: Entity) {
///     let motor = AngularMotor::default().with_target_velocity(-20.0).with_max_torque(30.0);
///     commands.spawn((
///         RevoluteJoint::new(car, wheel).with_local_anchor1(Vector::new(0.8, -0.3)).with_motor(motor),
///         JointCollisionDisabled,
///     ));
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, MapEntities, PartialEq)]
#[component(map_entities)]
pub struct RevoluteJoint {
    /// The first body.
    pub body1: Entity,
    /// The second body.
    pub body2: Entity,
    /// The frame on the first body.
    pub frame1: JointFrame,
    /// The frame on the second body.
    pub frame2: JointFrame,
    /// Minimum and maximum angle, if any.
    pub angle_limit: Option<AngleLimit>,
    /// Compliance of the anchors, in m/N. 0 is rigid.
    pub point_compliance: Scalar,
    /// Compliance of the limits, in rad/(N·m). 0 is rigid.
    pub limit_compliance: Scalar,
    /// The motor. Disabled by default.
    pub motor: AngularMotor,
}

crate::type_path::type_path!(RevoluteJoint, "dynamics::joints::revolute");

impl RevoluteJoint {
    /// A joint at the origins of two bodies, without limits.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self {
            body1,
            body2,
            frame1: JointFrame::IDENTITY,
            frame2: JointFrame::IDENTITY,
            angle_limit: None,
            point_compliance: 0.0,
            limit_compliance: 0.0,
            motor: AngularMotor::new_disabled(MotorModel::DEFAULT),
        }
    }

    /// Sets the minimum and maximum angle, in radians.
    pub const fn with_angle_limits(mut self, min: Scalar, max: Scalar) -> Self {
        self.angle_limit = Some(AngleLimit::new(min, max));
        self
    }

    /// Sets all compliances.
    #[deprecated(since = "0.4.0", note = "use the methods for single compliances")]
    pub const fn with_compliance(mut self, compliance: Scalar) -> Self {
        self.point_compliance = compliance;
        self.limit_compliance = compliance;
        self
    }

    /// Sets the compliance of the anchors, in m/N.
    pub const fn with_point_compliance(mut self, compliance: Scalar) -> Self {
        self.point_compliance = compliance;
        self
    }

    /// Sets the compliance of the limits, in rad/(N·m).
    pub const fn with_limit_compliance(mut self, compliance: Scalar) -> Self {
        self.limit_compliance = compliance;
        self
    }

    /// Sets the motor.
    pub const fn with_motor(mut self, motor: AngularMotor) -> Self {
        self.motor = motor;
        self
    }
}

frame_methods!(RevoluteJoint);
between_two_bodies!(RevoluteJoint);

impl JointKind for RevoluteJoint {
    own_frames!();

    fn motor(&self) -> Option<usize> {
        Some(ANGLE)
    }

    fn set_axes(&self, mut def: JointDef) -> JointDef {
        def.axes[ANGLE] = limited(self.angle_limit, self.limit_compliance);
        def.axes[ANGLE].motor = angular_motor(&self.motor);
        def.with(TRANSLATIONS, locked(self.point_compliance))
    }
}
