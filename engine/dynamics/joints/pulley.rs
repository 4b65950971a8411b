//! [`PulleyJoint`]: a rope over two pulleys.

use bevy_ecs::{
    component::Component,
    entity::{Entity, EntityMapper, MapEntities},
    reflect::{ReflectComponent, ReflectMapEntities},
};
use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::solver::JointDef;

use super::{
    coupling::{CoupledEnd, Coupling, Sum},
    frame::{JointAnchor, JointFrame},
    kind::{EntityConstraint, JointKind, between_two_bodies},
};
use crate::math::{Scalar, Vector};

/// Hangs two bodies on the ends of a rope over two pulleys in the world: as one goes up, the other goes down.
/// Beyond Avian.
///
/// The distance of the first body from its pulley, and `ratio` times that of the second from its own, are
/// together no longer than the rope. The rope may be slack, and does not stop an end at its pulley.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn hang(mut commands: Commands, cabin: Entity, weight: Entity) {
///     let pulleys = [Vector::Y * 10.0, Vector::Y * 10.0 + Vector::X * 2.0];
///     // As long as it has to be for where both are now.
///     let rope = PulleyJoint::new(cabin, weight, pulleys).with_local_anchor1(Vector::Y);
///     commands.spawn(rope);
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, MapEntities, PartialEq)]
#[component(map_entities)]
pub struct PulleyJoint {
    /// The first body.
    pub body1: Entity,
    /// The second body.
    pub body2: Entity,
    /// The point of the first body at which the rope ends.
    pub anchor1: JointAnchor,
    /// The point of the second body at which the rope ends.
    pub anchor2: JointAnchor,
    /// The pulleys of the first and of the second body, in the world, in metres.
    pub pulleys: [Vector; 2],
    /// The weight of the second distance: 2 for a block and tackle, in which the second body moves half
    /// as far. Not 0.
    pub ratio: Scalar,
    /// The length of the rope in metres. `None`, the default, is as long as it has to be where the bodies are
    /// as the joint begins to act.
    pub length: Option<Scalar>,
    /// How far the rope gives way, in m/N. 0 for not at all.
    pub compliance: Scalar,
}

impl PulleyJoint {
    /// A rope between the origins of two bodies over pulleys at two points in the world, which is taut where
    /// the bodies are.
    pub const fn new(body1: Entity, body2: Entity, pulleys: [Vector; 2]) -> Self {
        Self {
            body1,
            body2,
            anchor1: JointAnchor::ZERO,
            anchor2: JointAnchor::ZERO,
            pulleys,
            ratio: 1.0,
            length: None,
            compliance: 0.0,
        }
    }

    /// Sets the anchor on the first body, relative to it, in metres.
    pub const fn with_local_anchor1(mut self, anchor: Vector) -> Self {
        self.anchor1 = JointAnchor::Local(anchor);
        self
    }

    /// Sets the anchor on the second body, relative to it, in metres.
    pub const fn with_local_anchor2(mut self, anchor: Vector) -> Self {
        self.anchor2 = JointAnchor::Local(anchor);
        self
    }

    /// Sets the weight of the second distance.
    pub const fn with_ratio(mut self, ratio: Scalar) -> Self {
        self.ratio = ratio;
        self
    }

    /// Sets the length of the rope, in metres.
    pub const fn with_length(mut self, length: Scalar) -> Self {
        self.length = Some(length);
        self
    }

    /// Sets how far the rope gives way, in m/N.
    pub const fn with_compliance(mut self, compliance: Scalar) -> Self {
        self.compliance = compliance;
        self
    }
}

between_two_bodies!(PulleyJoint);

impl JointKind for PulleyJoint {
    fn frames(&self) -> [JointFrame; 2] {
        [self.anchor1.into(), self.anchor2.into()]
    }

    fn set_frames(&mut self, [frame1, frame2]: [JointFrame; 2]) {
        (self.anchor1, self.anchor2) = (frame1.anchor, frame2.anchor);
    }

    fn set_axes(&self, def: JointDef) -> JointDef {
        def
    }

    fn coupling(&self) -> Option<Coupling> {
        let end = |anchor: &JointAnchor, pulley| Some(CoupledEnd::Distance([anchor.local()?, pulley]));
        let [one, other] = self.pulleys;
        Some(Coupling {
            ends: [end(&self.anchor1, one)?, end(&self.anchor2, other)?],
            ratio: self.ratio,
            sum: self.length.map_or(Sum::AtMostNow, Sum::AtMost),
            compliance: self.compliance,
        })
    }
}
