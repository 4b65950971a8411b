//! [`RevoluteJoint`] in 3D: hinges and wheels.

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
        JointDef,
        coordinate::{SWING_Y, SWING_Z, TWIST},
    },
};

use super::super::{
    frame::{JointAnchor, JointBasis, JointFrame, frame_methods},
    kind::{EntityConstraint, JointKind, angular_motor, between_two_bodies, limited, locked, own_frames},
    limits::AngleLimit,
    motor::{AngularMotor, MotorModel},
    space::{Isometry, Rot, TRANSLATIONS, rotation_of, turn_to},
};
use crate::math::{Scalar, Vector};

/// Holds a point and an axis of one body at a point and an axis of another and lets the bodies turn about the
/// axis: hinges, doors, wheels.
///
/// The joint angle is measured from the first basis to the second about the axis, right-handed. It may have
/// limits, even beyond a full turn, and a motor.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn hang(mut commands: Commands, wall: Entity, door: Entity) {
///     // About the y axis at the edge of the door, from closed to wide open.
///     let hinge = RevoluteJoint::new(wall, door).with_hinge_axis(Vector::Y).with_angle_limits(0.0, 2.5);
///     commands.spawn((hinge.with_anchor(Vector::X * 0.5), JointCollisionDisabled));
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
    /// The direction of the axis in the joint's frames. Its length does not matter.
    pub hinge_axis: Vector,
    /// Minimum and maximum angle, if any.
    pub angle_limit: Option<AngleLimit>,
    /// Compliance of the anchors, in m/N. 0 is rigid.
    pub point_compliance: Scalar,
    /// Compliance of the axes, in rad/(N·m). 0 is rigid.
    pub align_compliance: Scalar,
    /// Compliance of the limits, in rad/(N·m). 0 is rigid.
    pub limit_compliance: Scalar,
    /// The motor. Disabled by default.
    pub motor: AngularMotor,
}

crate::type_path::type_path!(RevoluteJoint, "dynamics::joints::revolute");

impl RevoluteJoint {
    /// The z axis.
    pub const DEFAULT_HINGE_AXIS: Vector = Vector::Z;

    /// A joint at the origins and about the z axes of two bodies, without limits.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self {
            body1,
            body2,
            frame1: JointFrame::IDENTITY,
            frame2: JointFrame::IDENTITY,
            hinge_axis: Self::DEFAULT_HINGE_AXIS,
            angle_limit: None,
            point_compliance: 0.0,
            align_compliance: 0.0,
            limit_compliance: 0.0,
            motor: AngularMotor::new_disabled(MotorModel::DEFAULT),
        }
    }

    /// Sets the axis, in the joint's frames.
    pub const fn with_hinge_axis(mut self, axis: Vector) -> Self {
        self.hinge_axis = axis;
        self
    }

    /// Sets the axis.
    #[deprecated(since = "0.4.0", note = "renamed to `with_hinge_axis`")]
    pub const fn with_aligned_axis(self, axis: Vector) -> Self {
        self.with_hinge_axis(axis)
    }

    /// The axis relative to the first body, if its basis is local.
    pub fn local_hinge_axis1(&self) -> Option<Vector> {
        Some(rotation_of(self.local_basis1()?) * self.hinge_axis)
    }

    /// The axis relative to the second body, if its basis is local.
    pub fn local_hinge_axis2(&self) -> Option<Vector> {
        Some(rotation_of(self.local_basis2()?) * self.hinge_axis)
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
        self.align_compliance = compliance;
        self.limit_compliance = compliance;
        self
    }

    /// Sets the compliance of the anchors, in m/N.
    pub const fn with_point_compliance(mut self, compliance: Scalar) -> Self {
        self.point_compliance = compliance;
        self
    }

    /// Sets the compliance of the axes, in rad/(N·m).
    pub const fn with_align_compliance(mut self, compliance: Scalar) -> Self {
        self.align_compliance = compliance;
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
        Some(TWIST)
    }

    fn turn(&self) -> KernelRot {
        turn_to(self.hinge_axis)
    }

    fn set_axes(&self, mut def: JointDef) -> JointDef {
        def.axes[TWIST] = limited(self.angle_limit, self.limit_compliance);
        def.axes[TWIST].motor = angular_motor(&self.motor);
        def.with(TRANSLATIONS, locked(self.point_compliance))
            .with([SWING_Y, SWING_Z], locked(self.align_compliance))
    }
}
