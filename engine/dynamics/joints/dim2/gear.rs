//! [`GearJoint`]: meshing gears.

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

/// Couples two wheels as meshing gears: the angle of the first wheel plus `ratio` times the angle of the
/// second is constant. Beyond Avian.
///
/// The joint couples only rotations: each wheel needs its own hinge, such as a
/// [`RevoluteJoint`](super::RevoluteJoint) to a post. Full turns are counted, and the teeth do not slip. The
/// wheels mesh at the angles at which the joint starts to act.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn mesh(mut commands: Commands, small: Entity, large: Entity) {
///     // The small wheel makes three turns for one of the large, the other way round.
///     commands.spawn((GearJoint::new(small, large).with_radii(0.5, 1.5), JointCollisionDisabled));
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, MapEntities, PartialEq)]
#[component(map_entities)]
pub struct GearJoint {
    /// The first wheel.
    pub body1: Entity,
    /// The second wheel.
    pub body2: Entity,
    /// The weight of the second angle. Positive for wheels that turn in opposite directions, negative for a
    /// chain or an internal gear. Not 0.
    pub ratio: Scalar,
    /// Compliance of the teeth, in rad/(N·m) at the first wheel. 0 is rigid.
    pub compliance: Scalar,
}

crate::type_path::type_path!(GearJoint, "dynamics::joints::gear");

impl GearJoint {
    /// A joint of two wheels of equal size.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self { body1, body2, ratio: 1.0, compliance: 0.0 }
    }

    /// Sets the weight of the second angle.
    pub const fn with_ratio(mut self, ratio: Scalar) -> Self {
        self.ratio = ratio;
        self
    }

    /// Sets the ratio from the radii of two externally meshing wheels, in metres: the second over the first.
    pub const fn with_radii(self, radius1: Scalar, radius2: Scalar) -> Self {
        self.with_ratio(radius2 / radius1)
    }

    /// Sets the compliance of the teeth, in rad/(N·m) at the first wheel.
    pub const fn with_compliance(mut self, compliance: Scalar) -> Self {
        self.compliance = compliance;
        self
    }
}

between_two_bodies!(GearJoint);

impl JointKind for GearJoint {
    fn frames(&self) -> [JointFrame; 2] {
        [JointFrame::IDENTITY; 2]
    }

    fn set_frames(&mut self, _: [JointFrame; 2]) {}

    fn set_axes(&self, def: JointDef) -> JointDef {
        def
    }

    fn coupling(&self) -> Option<Coupling> {
        Some(Coupling {
            ends: [CoupledEnd::Turn(Vector::ZERO), CoupledEnd::Turn(Vector::ZERO)],
            ratio: self.ratio,
            sum: Sum::Kept,
            compliance: self.compliance,
        })
    }
}
