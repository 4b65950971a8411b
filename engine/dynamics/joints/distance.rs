//! [`DistanceJoint`]: rods, ropes and springs.

use bevy_ecs::{
    component::Component,
    entity::{Entity, EntityMapper, MapEntities},
    reflect::{ReflectComponent, ReflectMapEntities},
};
use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::solver::{Axis, JointDef, coordinate::DISTANCE};

use super::{
    frame::{JointAnchor, JointFrame},
    kind::{EntityConstraint, JointKind, between_two_bodies, locked},
    laws::give,
    limits::DistanceLimit,
    space::TRANSLATIONS,
};
use crate::math::{Scalar, Vector};

/// Keeps the distance between a point of one body and a point of another within limits. The bodies turn
/// freely.
///
/// Equal limits make a rod, a compliance makes a spring, and a maximum alone makes a rope. A distance of 0,
/// the default, holds the points together.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn hang(mut commands: Commands, ceiling: Entity, lamp: Entity) {
///     // A rope of 2 m.
///     commands.spawn(DistanceJoint::rope(ceiling, lamp, 2.0).with_local_anchor2(Vector::Y * 0.5));
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, MapEntities, PartialEq)]
#[component(map_entities)]
pub struct DistanceJoint {
    /// The first body.
    pub body1: Entity,
    /// The second body.
    pub body2: Entity,
    /// The point on the first body.
    pub anchor1: JointAnchor,
    /// The point on the second body.
    pub anchor2: JointAnchor,
    /// Minimum and maximum distance.
    pub limits: DistanceLimit,
    /// Compliance of the limits, in m/N. 0 is rigid.
    pub compliance: Scalar,
}

impl DistanceJoint {
    /// A joint that holds the origins of two bodies together.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self {
            body1,
            body2,
            anchor1: JointAnchor::ZERO,
            anchor2: JointAnchor::ZERO,
            limits: DistanceLimit::ZERO,
            compliance: 0.0,
        }
    }

    /// A rope: the origins of two bodies are at most `length` metres apart. Beyond Avian.
    pub const fn rope(body1: Entity, body2: Entity, length: Scalar) -> Self {
        Self::new(body1, body2).with_limits(0.0, length)
    }

    /// Sets both anchors to a point in the world, in metres.
    pub const fn with_anchor(mut self, anchor: Vector) -> Self {
        self.anchor1 = JointAnchor::FromGlobal(anchor);
        self.anchor2 = JointAnchor::FromGlobal(anchor);
        self
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

    /// The anchor on the first body in metres, if it is local.
    pub const fn local_anchor1(&self) -> Option<Vector> {
        self.anchor1.local()
    }

    /// The anchor on the second body in metres, if it is local.
    pub const fn local_anchor2(&self) -> Option<Vector> {
        self.anchor2.local()
    }

    /// Sets the minimum and maximum distance to one value, in metres.
    #[deprecated(since = "0.4.0", note = "use `with_limits`")]
    pub const fn with_rest_length(mut self, rest_length: Scalar) -> Self {
        self.limits = DistanceLimit::new(rest_length, rest_length);
        self
    }

    /// Sets the minimum and maximum distance, in metres.
    pub const fn with_limits(mut self, min: Scalar, max: Scalar) -> Self {
        self.limits = DistanceLimit::new(min, max);
        self
    }

    /// Sets the minimum distance, in metres. A maximum distance below it is removed: the points may be any
    /// distance apart.
    pub const fn with_min_distance(mut self, min: Scalar) -> Self {
        self.limits.min = min;
        if self.limits.max < min {
            self.limits.max = Scalar::MAX;
        }
        self
    }

    /// Sets the maximum distance, in metres.
    pub const fn with_max_distance(mut self, max: Scalar) -> Self {
        self.limits.max = max;
        self
    }

    /// Sets the compliance of the limits, in m/N.
    pub const fn with_compliance(mut self, compliance: Scalar) -> Self {
        self.compliance = compliance;
        self
    }
}

between_two_bodies!(DistanceJoint);

impl JointKind for DistanceJoint {
    fn frames(&self) -> [JointFrame; 2] {
        [self.anchor1.into(), self.anchor2.into()]
    }

    fn set_frames(&mut self, [frame1, frame2]: [JointFrame; 2]) {
        (self.anchor1, self.anchor2) = (frame1.anchor, frame2.anchor);
    }

    fn set_axes(&self, def: JointDef) -> JointDef {
        let [min, max] = self.limits.into();
        // A distance of 0 has no direction.
        if max == 0.0 && min <= 0.0 {
            return def.with(TRANSLATIONS, locked(self.compliance));
        }
        def.with([DISTANCE], Axis::limited(min, max).with_give(give(self.compliance)))
    }
}
