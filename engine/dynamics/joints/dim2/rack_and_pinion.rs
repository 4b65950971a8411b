//! [`RackAndPinionJoint`]: a pinion that drives a rack.

use bevy_ecs::{
    component::Component,
    entity::{Entity, EntityMapper, MapEntities},
    reflect::{ReflectComponent, ReflectMapEntities},
};
use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::solver::JointDef;

use super::super::{
    coupling::{CoupledEnd, Coupling, Sum},
    frame::JointFrame,
    kind::{EntityConstraint, JointKind, between_two_bodies},
};
use crate::math::{Scalar, Vector};

/// Couples a rack to a pinion: per radian that the pinion turns, the rack slides by the pinion's radius.
/// Beyond Avian.
///
/// The joint couples only these two motions: the pinion needs its own hinge, such as a
/// [`RevoluteJoint`](super::RevoluteJoint), and the rack its own slider, such as a
/// [`PrismaticJoint`](super::PrismaticJoint). Full turns are counted, and the teeth do not slip. Rack and
/// pinion mesh at the poses at which the joint starts to act.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn mesh(mut commands: Commands, pinion: Entity, rack: Entity) {
///     // The rack is below the pinion.
///     let joint = RackAndPinionJoint::new(pinion, rack).with_rack_axis(Vector::X).with_radius(0.5);
///     commands.spawn((joint, JointCollisionDisabled));
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, MapEntities, PartialEq)]
#[component(map_entities)]
pub struct RackAndPinionJoint {
    /// The pinion.
    pub body1: Entity,
    /// The rack.
    pub body2: Entity,
    /// The world direction in which the rack moves when the pinion turns counter-clockwise. Its length does
    /// not matter.
    pub rack_axis: Vector,
    /// The radius of the pinion, in metres. Not 0.
    pub radius: Scalar,
    /// Compliance of the teeth, in rad/(N·m) at the pinion. 0 is rigid.
    pub compliance: Scalar,
}

crate::type_path::type_path!(RackAndPinionJoint, "dynamics::joints::rack_and_pinion");

impl RackAndPinionJoint {
    /// A pinion with a radius of 1 m, and a rack below it that moves along the x axis.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self { body1, body2, rack_axis: Vector::X, radius: 1.0, compliance: 0.0 }
    }

    /// Sets the world direction in which the rack moves when the pinion turns counter-clockwise.
    pub const fn with_rack_axis(mut self, axis: Vector) -> Self {
        self.rack_axis = axis;
        self
    }

    /// Sets the radius of the pinion, in metres.
    pub const fn with_radius(mut self, radius: Scalar) -> Self {
        self.radius = radius;
        self
    }

    /// Sets the compliance of the teeth, in rad/(N·m) at the pinion.
    pub const fn with_compliance(mut self, compliance: Scalar) -> Self {
        self.compliance = compliance;
        self
    }
}

between_two_bodies!(RackAndPinionJoint);

impl JointKind for RackAndPinionJoint {
    fn frames(&self) -> [JointFrame; 2] {
        [JointFrame::IDENTITY; 2]
    }

    fn set_frames(&mut self, _: [JointFrame; 2]) {}

    fn set_axes(&self, def: JointDef) -> JointDef {
        def
    }

    fn coupling(&self) -> Option<Coupling> {
        Some(Coupling {
            ends: [CoupledEnd::Turn(Vector::ZERO), CoupledEnd::Shift(self.rack_axis)],
            ratio: -1.0 / self.radius,
            sum: Sum::Kept,
            compliance: self.compliance,
        })
    }
}
