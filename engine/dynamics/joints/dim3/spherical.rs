//! [`SphericalJoint`]: a ball and socket.

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
        coordinate::{CONE, SWING_Y, SWING_Z, TWIST},
    },
};

use super::super::{
    frame::{JointAnchor, JointBasis, JointFrame, frame_methods},
    kind::{EntityConstraint, JointKind, between_two_bodies, limited, locked, own_frames},
    limits::AngleLimit,
    motor::MotorModel,
    space::{Isometry, Rot, TRANSLATIONS, rotation_of, turn_to},
};
use super::spherical_motor::SphericalMotor;
use crate::math::{Scalar, Vector};

/// Holds a point of one body at a point of another and lets the bodies turn freely: shoulders, chains,
/// trailers.
///
/// Swing is the angle between the twist axes of both frames, from 0 to π. Twist is the angle about the twist
/// axes. Both may have limits, and a motor may turn the joint to a rotation.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn join(mut commands: Commands, chest: Entity, arm: Entity) {
///     let shoulder = SphericalJoint::new(chest, arm)
///         .with_local_anchor1(Vector::new(0.3, 0.4, 0.0))
///         .with_local_anchor2(Vector::Y * 0.3)
///         .with_swing_limits(0.0, 1.2)
///         .with_twist_limits(-0.8, 0.8);
///     commands.spawn((shoulder, JointCollisionDisabled));
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, MapEntities, PartialEq)]
#[component(map_entities)]
pub struct SphericalJoint {
    /// The first body.
    pub body1: Entity,
    /// The second body.
    pub body2: Entity,
    /// The frame on the first body.
    pub frame1: JointFrame,
    /// The frame on the second body.
    pub frame2: JointFrame,
    /// The direction of the twist axis in the joint's frames. Its length does not matter.
    pub twist_axis: Vector,
    /// Minimum and maximum swing, if any. Swing is never negative, so a minimum below 0 has no effect.
    pub swing_limit: Option<AngleLimit>,
    /// Minimum and maximum twist, if any.
    pub twist_limit: Option<AngleLimit>,
    /// Compliance of the anchors, in m/N. 0 is rigid.
    pub point_compliance: Scalar,
    /// Compliance of the swing limits, in rad/(N·m). 0 is rigid.
    pub swing_compliance: Scalar,
    /// Compliance of the twist limits, in rad/(N·m). 0 is rigid.
    pub twist_compliance: Scalar,
    /// The motor. Disabled by default.
    pub motor: SphericalMotor,
}

crate::type_path::type_path!(SphericalJoint, "dynamics::joints::spherical");

impl SphericalJoint {
    /// The y axis.
    pub const DEFAULT_TWIST_AXIS: Vector = Vector::Y;

    /// A joint at the origins of two bodies, without limits.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self {
            body1,
            body2,
            frame1: JointFrame::IDENTITY,
            frame2: JointFrame::IDENTITY,
            twist_axis: Self::DEFAULT_TWIST_AXIS,
            swing_limit: None,
            twist_limit: None,
            point_compliance: 0.0,
            swing_compliance: 0.0,
            twist_compliance: 0.0,
            motor: SphericalMotor::new_disabled(MotorModel::DEFAULT),
        }
    }

    /// Sets the twist axis, in the joint's frames.
    pub const fn with_twist_axis(mut self, twist_axis: Vector) -> Self {
        self.twist_axis = twist_axis;
        self
    }

    /// The twist axis relative to the first body, if its basis is local.
    pub fn local_twist_axis1(&self) -> Option<Vector> {
        Some(rotation_of(self.local_basis1()?) * self.twist_axis)
    }

    /// The twist axis relative to the second body, if its basis is local.
    pub fn local_twist_axis2(&self) -> Option<Vector> {
        Some(rotation_of(self.local_basis2()?) * self.twist_axis)
    }

    /// Sets the minimum and maximum swing, in radians.
    pub const fn with_swing_limits(mut self, min: Scalar, max: Scalar) -> Self {
        self.swing_limit = Some(AngleLimit::new(min, max));
        self
    }

    /// Sets the minimum and maximum twist, in radians.
    pub const fn with_twist_limits(mut self, min: Scalar, max: Scalar) -> Self {
        self.twist_limit = Some(AngleLimit::new(min, max));
        self
    }

    /// Sets all compliances.
    #[deprecated(since = "0.4.0", note = "use the methods for single compliances")]
    pub const fn with_compliance(mut self, compliance: Scalar) -> Self {
        self.point_compliance = compliance;
        self.swing_compliance = compliance;
        self.twist_compliance = compliance;
        self
    }

    /// Sets the compliance of the anchors, in m/N.
    pub const fn with_point_compliance(mut self, compliance: Scalar) -> Self {
        self.point_compliance = compliance;
        self
    }

    /// Sets the compliance of the swing limits, in rad/(N·m).
    pub const fn with_swing_compliance(mut self, compliance: Scalar) -> Self {
        self.swing_compliance = compliance;
        self
    }

    /// Sets the compliance of the twist limits, in rad/(N·m).
    pub const fn with_twist_compliance(mut self, compliance: Scalar) -> Self {
        self.twist_compliance = compliance;
        self
    }

    /// Sets the motor.
    pub const fn with_motor(mut self, motor: SphericalMotor) -> Self {
        self.motor = motor;
        self
    }
}

frame_methods!(SphericalJoint);
between_two_bodies!(SphericalJoint);

impl JointKind for SphericalJoint {
    own_frames!();

    fn turn(&self) -> KernelRot {
        turn_to(self.twist_axis)
    }

    fn set_axes(&self, mut def: JointDef) -> JointDef {
        def.axes[TWIST] = limited(self.twist_limit, self.twist_compliance);
        self.motor.set_motors(&mut def, self.turn());
        match self.swing_limit {
            // A swing of 0 has no direction.
            Some(AngleLimit { min, max: 0.0 }) if min <= 0.0 => {
                def = def.with([SWING_Y, SWING_Z], locked(self.swing_compliance));
            }
            limit => def.axes[CONE] = limited(limit, self.swing_compliance),
        }
        def.with(TRANSLATIONS, locked(self.point_compliance))
    }
}
