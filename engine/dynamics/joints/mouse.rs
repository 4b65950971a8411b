//! [`MouseJoint`]: pulls a body to a pose.

use bevy_ecs::{
    component::Component,
    entity::{Entity, EntityMapper, MapEntities},
    lifecycle::HookContext,
    reflect::{ReflectComponent, ReflectMapEntities},
    world::DeferredWorld,
};
use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::solver::{Axis, JointDef};

use super::{
    frame::{JointAnchor, JointFrame},
    kind::{EntityConstraint, JointKind, axis_motor, orientation_motor},
    motor::{AxisMotor, MotorModel},
    space::TRANSLATIONS,
};
use crate::{
    dynamics::rigid_body::RigidBody,
    math::{Scalar, Vector},
};

/// Pulls a point of a body to the position of this entity, by a damped spring with a maximum force: to drag
/// bodies with the mouse, or to carry them in front of a camera. Beyond Avian.
///
/// The pose of the joint's own entity is the target: move the entity by its `Transform` or
/// [`Position`](crate::physics_transform::Position) in any frame, or make it the child of another entity. For
/// this purpose the entity is a kinematic body. With a [`max_torque`](Self::max_torque) the body also turns
/// to the entity's rotation.
///
/// To drag another body, change [`body`](Self::body) or insert the component again. Assigning a new
/// `MouseJoint` to the component in place has no effect, because the new value does not know its entity.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// fn pick(mut commands: Commands, barrel: Entity, cursor: Transform) {
///     // At the point of the barrel that is under the cursor now.
///     commands.spawn((MouseJoint::new(barrel).with_anchor(Vector::X).with_max_force(500.0), cursor));
/// }
///
/// fn drag(mut targets: Query<&mut Transform, With<MouseJoint>>) {
///     for mut target in &mut targets {
///         target.translation.x += 0.1;
///     }
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, MapEntities, PartialEq)]
#[component(map_entities, on_insert = note_own_entity)]
#[require(RigidBody = RigidBody::Kinematic)]
pub struct MouseJoint {
    /// The entity of this component.
    target: Entity,
    /// The body that is pulled.
    pub body: Entity,
    /// The anchor point on the body. The body's origin by default.
    pub anchor: JointAnchor,
    /// Stiffness and damping of the pull. By default a critically damped spring of 5 Hz.
    pub motor_model: MotorModel,
    /// Maximum force along each axis of the target, in N. By default [`Scalar::MAX`], which is no maximum.
    pub max_force: Scalar,
    /// Maximum torque, in N·m. 0 by default: the body turns freely.
    pub max_torque: Scalar,
}

/// Stores the entity of a component that was inserted.
fn note_own_entity(mut world: DeferredWorld, context: HookContext) {
    if let Some(mut joint) = world.get_mut::<MouseJoint>(context.entity) {
        joint.target = context.entity;
    }
}

impl MouseJoint {
    /// A joint at the origin of a body, without a maximum force.
    pub const fn new(body: Entity) -> Self {
        Self {
            target: Entity::PLACEHOLDER,
            body,
            anchor: JointAnchor::ZERO,
            motor_model: MotorModel::DEFAULT,
            max_force: Scalar::MAX,
            max_torque: 0.0,
        }
    }

    /// Sets the anchor to the point of the body at a world position, in metres.
    pub const fn with_anchor(mut self, anchor: Vector) -> Self {
        self.anchor = JointAnchor::FromGlobal(anchor);
        self
    }

    /// Sets the anchor on the body, relative to it, in metres.
    pub const fn with_local_anchor(mut self, anchor: Vector) -> Self {
        self.anchor = JointAnchor::Local(anchor);
        self
    }

    /// Sets the stiffness and damping of the pull.
    pub const fn with_motor_model(mut self, motor_model: MotorModel) -> Self {
        self.motor_model = motor_model;
        self
    }

    /// Sets the maximum force, in N.
    pub const fn with_max_force(mut self, max_force: Scalar) -> Self {
        self.max_force = max_force;
        self
    }

    /// Sets the maximum torque, in N·m.
    pub const fn with_max_torque(mut self, max_torque: Scalar) -> Self {
        self.max_torque = max_torque;
        self
    }
}

impl EntityConstraint<2> for MouseJoint {
    fn entities(&self) -> [Entity; 2] {
        [self.target, self.body]
    }
}

impl MapEntities for MouseJoint {
    fn map_entities<M: EntityMapper>(&mut self, mapper: &mut M) {
        self.target = mapper.get_mapped(self.target);
        self.body = mapper.get_mapped(self.body);
    }
}

impl JointKind for MouseJoint {
    fn frames(&self) -> [JointFrame; 2] {
        [JointFrame::IDENTITY, self.anchor.into()]
    }

    fn set_frames(&mut self, [_, frame]: [JointFrame; 2]) {
        self.anchor = frame.anchor;
    }

    fn set_axes(&self, def: JointDef) -> JointDef {
        let motor = AxisMotor::new(self.motor_model).with_max_effort(self.max_force);
        let mut def = def.with(TRANSLATIONS, Axis { motor: axis_motor(&motor), ..Axis::FREE });
        if self.max_torque != 0.0 {
            def.orientation = orientation_motor(self.motor_model, self.max_torque);
        }
        def
    }
}
