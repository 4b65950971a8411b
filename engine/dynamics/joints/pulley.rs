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

/// Hangs two bodies on the ends of a rope over two pulleys fixed in the world: when one body goes up, the
/// other goes down. Beyond Avian.
///
/// The distance of the first body from its pulley plus `ratio` times the distance of the second body from its
/// pulley is at most the rope's length. The rope may be slack, and the joint does not stop a body at its
/// pulley.
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
    /// The point of the first body that is attached to the rope.
    pub anchor1: JointAnchor,
    /// The point of the second body that is attached to the rope.
    pub anchor2: JointAnchor,
    /// The pulleys of the first and of the second body, in the world, in metres.
    pub pulleys: [Vector; 2],
    /// The weight of the second distance. 2 is a block and tackle: the second body moves half as far. Not 0.
    pub ratio: Scalar,
    /// The length of the rope in metres. With `None`, the default, the rope is taut at the poses at which the
    /// joint starts to act.
    pub length: Option<Scalar>,
    /// Compliance of the rope, in m/N. 0 is rigid.
    pub compliance: Scalar,
}

impl PulleyJoint {
    /// A rope between the origins of two bodies over pulleys at two world points. The rope is taut at the
    /// initial poses of the bodies.
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

    /// Sets the compliance of the rope, in m/N.
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
