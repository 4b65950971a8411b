//! Continuous collision detection: how far ahead contacts of a collider are predicted.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use derive_more::From;

use crate::math::Scalar;

/// Maximum distance at which contacts of a body or collider are predicted, in metres, so that the body stops at a
/// surface before passing it.
///
/// A *speculative* contact exists while the shapes are still separated. The solver lets them close the gap within the
/// step and no further. The margin never exceeds the motion of both in one step, so a large one costs little. But a
/// body may be stopped by a surface that it would have slid past: a *ghost collision*, which a smaller margin avoids.
///
/// Read from the collider, else from its body, else
/// [`NarrowPhaseConfig::default_speculative_margin`](crate::collision::narrow_phase::NarrowPhaseConfig::default_speculative_margin).
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn spawn_ghost(mut commands: Commands) {
///     // Contacts only once the shapes touch; tunnels when fast.
///     commands.spawn((RigidBody::Dynamic, SpeculativeMargin::ZERO));
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, Deref, DerefMut, PartialEq, Reflect, From)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Component, Debug, PartialEq, Clone)]
pub struct SpeculativeMargin(pub Scalar);

impl SpeculativeMargin {
    /// No contact before the shapes touch.
    pub const ZERO: Self = Self(0.0);

    /// The full motion of the shapes in a step.
    pub const MAX: Self = Self(Scalar::MAX);
}

#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
