//! Continuous collision: how far ahead of a moving collider its contacts are computed.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use derive_more::From;

use crate::math::Scalar;

/// How far ahead contacts of a body or collider are computed, so that it is stopped at a surface before it has passed it, in metres.
///
/// A *speculative* contact exists while the shapes are still apart; the solver lets them close the gap within the step and no
/// further. The margin never reaches farther than the two move in one step, so a large one costs little; but a body that is
/// caught by a surface it would have slid past feels a *ghost collision*, which a smaller margin avoids.
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

    /// As far ahead as the shapes can come in a step.
    pub const MAX: Self = Self(Scalar::MAX);
}

#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
