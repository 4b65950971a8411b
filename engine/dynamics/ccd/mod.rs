//! Continuous collision detection (CCD): fast bodies and thin shapes do not pass through each other.
//!
//! A step moves a body by its velocity. A small fast body may be in front of a wall in one step and behind it
//! in the next. Three mechanisms prevent that:
//!
//! - **Speculative contacts**, for all bodies: contacts between shapes that the motion of the step brings
//!   together, created before the shapes touch. The solver lets the gap close and no further, and bounces and
//!   friction are as in an impact. Other shapes are not affected. [`SpeculativeMargin`] limits the distance
//!   of prediction.
//! - **A sweep against static geometry**, for all bodies that move farther in a step than half the radius of
//!   the ball inscribed in their collider. A body that entered or crossed static geometry is moved back to
//!   the time of impact. The next step continues there with the contact.
//! - **[`SweptCcd`]**, for bodies with the component: the same sweep against kinematic and dynamic bodies.
//!
//! A body that is moved back loses the rest of the step and seems slower for a moment. Later obstacles of the
//! same step are hit in the next step. Bodies connected by joints are moved back together, and the joints do
//! not open.
//!
//! Bodies of 5 cm that spin at 20 rad/s, shot at a wall of 1 cm or more at 64 Hz:
//!
//! | wall | default | `SpeculativeMargin::ZERO` | and `SweptCcd` |
//! | --- | --- | --- | --- |
//! | static, up to 1000 m/s | stops | stops at the wall, then bounces | as without |
//! | kinematic or dynamic, up to 1000 m/s | most stop; of spinning ones up to a quarter passes in 2D, a twelfth in 3D | passes when it moves by more than its size | stops at the wall, then bounces |
//!
//! Without [`CcdPlugin`] there are no sweeps.

mod plugin;
pub(crate) mod sweep;

pub use plugin::CcdPlugin;

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use derive_more::From;

use crate::math::Scalar;

/// Maximum distance at which contacts of a body or collider are predicted, in metres, so that the body stops
/// at a surface before passing it.
///
/// A *speculative* contact exists while the shapes are still separated. The solver lets the shapes close the
/// gap within the step and no further. The margin never exceeds the motion of both shapes in one step, so a
/// large margin costs little. But it may stop a body at a surface that the body would have slid past: a
/// *ghost collision*. A smaller margin avoids ghost collisions.
///
/// Read from the collider, otherwise from its body, otherwise from
/// [`NarrowPhaseConfig::default_speculative_margin`](crate::collision::narrow_phase::NarrowPhaseConfig::default_speculative_margin).
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn spawn_ghost(mut commands: Commands) {
///     // Contacts only once the shapes touch. When fast, it passes what moves.
///     commands.spawn((RigidBody::Dynamic, SpeculativeMargin::ZERO));
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, Deref, DerefMut, PartialEq, Reflect, From)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Component, Debug, PartialEq, Clone)]
pub struct SpeculativeMargin(pub Scalar);

impl SpeculativeMargin {
    /// Contacts form only when the shapes touch.
    pub const ZERO: Self = Self(0.0);

    /// The margin is the full motion of the shapes in a step.
    pub const MAX: Self = Self(Scalar::MAX);
}

/// The systems that sweep bodies, after
/// [`SolverSystems::PostSubstep`](crate::dynamics::solver::schedule::SolverSystems::PostSubstep) and before
/// [`SolverSystems::Restitution`](crate::dynamics::solver::schedule::SolverSystems::Restitution).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SweptCcdSystems;

/// The former name of [`SweptCcdSystems`].
#[deprecated(since = "0.4.0", note = "renamed to `SweptCcdSystems`")]
pub type SweptCcdSet = SweptCcdSystems;

/// Sweeps a body against kinematic and dynamic bodies, so that it does not pass through them at any speed.
///
/// Both bodies are swept from their poses at the start of the step to their poses at its end. If they meet,
/// both move back to the time of impact and collide in the next step. All colliders of both bodies are swept.
/// Layers and sensors are respected as for contacts.
///
/// Most bodies do not need this component: contacts are predicted by default, and no body passes through
/// static geometry. It is for bodies with a small [`SpeculativeMargin`], and for bodies that must not miss an
/// obstacle even if a collision within the step deflects them.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn spawn_bullet(mut commands: Commands) {
///     commands.spawn((RigidBody::Dynamic, SweptCcd::default()));
///     // Without turning, and not against dynamic bodies:
///     commands.spawn((RigidBody::Dynamic, SweptCcd::LINEAR.include_dynamic(false)));
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Component, Debug, Default, PartialEq, Clone)]
pub struct SweptCcd {
    /// Whether rotation is swept.
    pub mode: SweepMode,
    /// Whether the body is also swept against dynamic bodies, not only against kinematic ones. True by
    /// default.
    pub include_dynamic: bool,
    /// Linear threshold: bodies whose relative velocities are below both thresholds are not swept. In m/s, 0
    /// by default.
    pub linear_threshold: Scalar,
    /// Angular threshold, in rad/s. 0 by default.
    pub angular_threshold: Scalar,
}

impl Default for SweptCcd {
    fn default() -> Self {
        Self::NON_LINEAR
    }
}

impl SweptCcd {
    /// Sweeps translation only.
    pub const LINEAR: Self = Self::new_with_mode(SweepMode::Linear);

    /// Sweeps translation and rotation.
    pub const NON_LINEAR: Self = Self::new_with_mode(SweepMode::NonLinear);

    /// A sweep with a mode, against all bodies and at all velocities.
    pub const fn new_with_mode(mode: SweepMode) -> Self {
        Self { mode, include_dynamic: true, linear_threshold: 0.0, angular_threshold: 0.0 }
    }

    /// Sweeps only pairs of bodies whose relative velocity exceeds one of the thresholds, in m/s and rad/s.
    pub const fn with_velocity_threshold(mut self, linear: Scalar, angular: Scalar) -> Self {
        self.linear_threshold = linear;
        self.angular_threshold = angular;
        self
    }

    /// Sets whether the body is swept against dynamic bodies.
    pub const fn include_dynamic(mut self, should_include: bool) -> Self {
        self.include_dynamic = should_include;
        self
    }
}

/// The motion that is swept for a body with [`SweptCcd`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq, Clone)]
pub enum SweepMode {
    /// Translation. Bodies that rotate fast may be missed.
    Linear,
    /// Translation and rotation, which costs more.
    #[default]
    NonLinear,
}

#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
