//! [`FixedJoint`]: joins two bodies rigidly.

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
    frame::{JointAnchor, JointBasis, JointFrame, frame_methods},
    kind::{EntityConstraint, JointKind, between_two_bodies, locked, own_frames},
    space::{Isometry, ROTATIONS, Rot, TRANSLATIONS},
};
use crate::math::{Scalar, Vector};

/// Joins two bodies as if they were one: their frames coincide.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn weld(mut commands: Commands, hull: Entity, mast: Entity) {
///     // As they are now, at a point of the world.
///     commands.spawn(FixedJoint::new(hull, mast).with_anchor(Vector::Y).with_basis(Rotation::IDENTITY));
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, MapEntities, PartialEq)]
#[component(map_entities)]
pub struct FixedJoint {
    /// The first body.
    pub body1: Entity,
    /// The second body.
    pub body2: Entity,
    /// The frame on the first body.
    pub frame1: JointFrame,
    /// The frame on the second body.
    pub frame2: JointFrame,
    /// Compliance of the anchors, in m/N. 0 is rigid.
    pub point_compliance: Scalar,
    /// Compliance of the bases, in rad/(N·m). 0 is rigid.
    pub angle_compliance: Scalar,
}

impl FixedJoint {
    /// A joint between the frames of two bodies.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self {
            body1,
            body2,
            frame1: JointFrame::IDENTITY,
            frame2: JointFrame::IDENTITY,
            point_compliance: 0.0,
            angle_compliance: 0.0,
        }
    }

    /// Sets both compliances.
    #[deprecated(since = "0.4.0", note = "use `with_point_compliance` and `with_angle_compliance`")]
    pub const fn with_compliance(mut self, compliance: Scalar) -> Self {
        self.point_compliance = compliance;
        self.angle_compliance = compliance;
        self
    }

    /// Sets the compliance of the anchors, in m/N.
    pub const fn with_point_compliance(mut self, compliance: Scalar) -> Self {
        self.point_compliance = compliance;
        self
    }

    /// Sets the compliance of the bases, in rad/(N·m).
    pub const fn with_angle_compliance(mut self, compliance: Scalar) -> Self {
        self.angle_compliance = compliance;
        self
    }
}

frame_methods!(FixedJoint);

between_two_bodies!(FixedJoint);

impl JointKind for FixedJoint {
    own_frames!();

    fn set_axes(&self, def: JointDef) -> JointDef {
        def.with(TRANSLATIONS, locked(self.point_compliance)).with(ROTATIONS, locked(self.angle_compliance))
    }
}
