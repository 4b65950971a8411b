//! [`JointBreakThreshold`]: joints that break under load, and [`JointBroken`].

use bevy_ecs::{prelude::*, reflect::ReflectComponent};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::{settings::JointForces, space::magnitude};
use crate::math::{AngularVector, Scalar, Vector};

/// The load above which the joint on the same entity breaks. Beyond Avian.
///
/// At the end of a step the engine compares the joint's [`JointForces`], a required component, with the
/// threshold. A joint with a higher load gets [`JointDisabled`](super::JointDisabled), has no effect from the
/// next step on, and is reported by [`JointBroken`]. Removing [`JointDisabled`](super::JointDisabled) repairs
/// the joint.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn glue(mut commands: Commands, wall: Entity, brick: Entity) {
///     commands
///         .spawn((FixedJoint::new(wall, brick).with_anchor(Vector::Y), JointBreakThreshold::force(500.0)))
///         .observe(|broken: On<JointBroken>, mut commands: Commands| {
///             println!("broken by {} N", broken.force.length());
///             commands.entity(broken.joint).despawn();
///         });
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
#[require(JointForces)]
pub struct JointBreakThreshold {
    /// Maximum force that the joint bears, in N. [`Scalar::INFINITY`] or NaN for no maximum.
    pub force: Scalar,
    /// Maximum torque that the joint bears, in N·m, excluding the torque of the force at the anchor.
    /// [`Scalar::INFINITY`] or NaN for no maximum.
    pub torque: Scalar,
}

impl Default for JointBreakThreshold {
    /// A joint that never breaks.
    fn default() -> Self {
        Self::new(Scalar::INFINITY, Scalar::INFINITY)
    }
}

impl JointBreakThreshold {
    /// A maximum force in N and a maximum torque in N·m.
    pub const fn new(force: Scalar, torque: Scalar) -> Self {
        Self { force, torque }
    }

    /// A maximum force in N, without a maximum torque.
    pub const fn force(force: Scalar) -> Self {
        Self::new(force, Scalar::INFINITY)
    }

    /// A maximum torque in N·m, without a maximum force.
    pub const fn torque(torque: Scalar) -> Self {
        Self::new(Scalar::INFINITY, torque)
    }

    /// Whether forces exceed the threshold.
    pub fn is_exceeded_by(&self, forces: &JointForces) -> bool {
        forces.force().length() > self.force || magnitude(forces.torque()) > self.torque
    }
}

/// A joint broke and now has [`JointDisabled`](super::JointDisabled). Written as a message, and triggered at
/// the joint's entity.
///
/// These events are sent at the end of a step, in
/// [`CollisionEventSystems`](crate::collision::narrow_phase::CollisionEventSystems): the messages, then the
/// triggers, in the order of the joints in the tables of the ECS.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct JointBroken {
    /// The joint's entity.
    #[event_target]
    pub joint: Entity,
    /// The joint's first body.
    pub body1: Entity,
    /// The joint's second body.
    pub body2: Entity,
    /// The force on the second body that broke the joint, along the world's axes, in N.
    pub force: Vector,
    /// The torque on the second body that broke the joint, about the world's axes, in N·m.
    pub torque: AngularVector,
}
