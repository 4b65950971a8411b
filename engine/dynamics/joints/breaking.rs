//! [`JointBreakThreshold`]: joints that break under load, and [`JointBroken`].

use bevy_ecs::{prelude::*, reflect::ReflectComponent};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::{settings::JointForces, space::magnitude};
use crate::math::{AngularVector, Scalar, Vector};

/// The load above which the joint of its entity breaks. Beyond Avian.
///
/// At the end of a step the joint's [`JointForces`], which the component brings along, are compared with it.
/// A joint that bears more gets [`JointDisabled`](super::JointDisabled) and is reported by [`JointBroken`]:
/// it has no effect from the next step on. Removing [`JointDisabled`](super::JointDisabled) mends it.
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
    /// The greatest force that the joint bears, in N. [`Scalar::INFINITY`] for any; NaN counts as that.
    pub force: Scalar,
    /// The greatest torque that the joint bears, in N·m, besides that of the force at the anchor.
    /// [`Scalar::INFINITY`] for any; NaN counts as that.
    pub torque: Scalar,
}

impl Default for JointBreakThreshold {
    /// Never breaks.
    fn default() -> Self {
        Self::new(Scalar::INFINITY, Scalar::INFINITY)
    }
}

impl JointBreakThreshold {
    /// A greatest force in N, and a greatest torque in N·m.
    pub const fn new(force: Scalar, torque: Scalar) -> Self {
        Self { force, torque }
    }

    /// A greatest force in N; any torque.
    pub const fn force(force: Scalar) -> Self {
        Self::new(force, Scalar::INFINITY)
    }

    /// A greatest torque in N·m; any force.
    pub const fn torque(torque: Scalar) -> Self {
        Self::new(Scalar::INFINITY, torque)
    }

    /// Whether forces are above it.
    pub fn is_exceeded_by(&self, forces: &JointForces) -> bool {
        forces.force().length() > self.force || magnitude(forces.torque()) > self.torque
    }
}

/// A joint broke, and has [`JointDisabled`](super::JointDisabled) now. Written as a message, and triggered at
/// the joint's entity.
///
/// Breaks are sent at the end of a step, in
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
    /// The force on the second body that broke it, along the world's axes, in N.
    pub force: Vector,
    /// The torque on the second body that broke it, about the world's axes, in N·m.
    pub torque: AngularVector,
}
