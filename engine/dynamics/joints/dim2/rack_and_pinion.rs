//! [`RackAndPinionJoint`]: a rack that a wheel moves.

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

/// Lets a rack slide as a pinion turns: a radian moves it by the pinion's radius. Beyond Avian.
///
/// It ties both only: the pinion needs a hinge of its own, such as a [`RevoluteJoint`](super::RevoluteJoint),
/// and the rack a slide, such as a [`PrismaticJoint`](super::PrismaticJoint). Turns are counted, and nothing
/// slips. Where both are as the joint begins to act is where they mesh.
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
    /// The direction in the world in which the rack moves as the pinion turns counter-clockwise. Its length
    /// does not matter.
    pub rack_axis: Vector,
    /// The radius of the pinion, in metres. Not 0.
    pub radius: Scalar,
    /// How far the teeth give way, in rad/(N·m) at the pinion. 0 for not at all.
    pub compliance: Scalar,
}

crate::type_path::type_path!(RackAndPinionJoint, "dynamics::joints::rack_and_pinion");

impl RackAndPinionJoint {
    /// A pinion of a metre, and a rack that moves along the x axis: below it.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self { body1, body2, rack_axis: Vector::X, radius: 1.0, compliance: 0.0 }
    }

    /// Sets the direction in the world in which the rack moves as the pinion turns counter-clockwise.
    pub const fn with_rack_axis(mut self, axis: Vector) -> Self {
        self.rack_axis = axis;
        self
    }

    /// Sets the radius of the pinion, in metres.
    pub const fn with_radius(mut self, radius: Scalar) -> Self {
        self.radius = radius;
        self
    }

    /// Sets how far the teeth give way, in rad/(N·m) at the pinion.
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
