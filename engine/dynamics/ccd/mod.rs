//! Continuous collision detection: what is fast or thin collides too.
//!
//! A step moves a body by its velocity. A small fast body may be in front of a wall in one step and behind it
//! in the next. Three things prevent that:
//!
//! - **Speculative contacts**, for all bodies: contacts of what the motion of the step brings together, made
//!   before the shapes touch. The solver lets the gap close and no further, so that bounces and friction are
//!   those of an impact. What the motion does not bring together is not affected. [`SpeculativeMargin`]
//!   limits how far ahead a body looks.
//! - **A sweep against what does not move**, for all bodies that move farther in a step than half the ball
//!   within their collider: one that got into or through static geometry is put back to the time of the
//!   impact. The next step continues there with the contact.
//! - **[`SweptCcd`]**, for bodies with the component: the same against kinematic and dynamic bodies.
//!
//! A body that is put back loses the rest of the step: for a moment it seems slower. What it would have hit
//! later in the same step, it hits in the next one. What joints hold to it is put back with it, so that
//! they do not open.
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
/// A *speculative* contact exists while the shapes are still separated. The solver lets them close the gap
/// within the step and no further. The margin never exceeds the motion of both in one step, so a large one
/// costs little. But a body may be stopped by a surface that it would have slid past: a *ghost collision*,
/// which a smaller margin avoids.
///
/// Read from the collider, else from its body, else
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
    /// No contact before the shapes touch.
    pub const ZERO: Self = Self(0.0);

    /// The full motion of the shapes in a step.
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

/// Sweeps a body against kinematic and dynamic bodies, so that none passes the other, however fast.
///
/// Both bodies are swept from where they were to where they are at the end of the step. If they meet, both go
/// back to where they met, and collide in the next step. Layers and sensors count as for contacts. All
/// colliders of both bodies are swept.
///
/// Most bodies do not need it: contacts are predicted by default, and no body passes what is static. It is
/// for bodies whose [`SpeculativeMargin`] is small, and where something must not be missed also if a
/// collision within the step gives it another way.
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
    /// Whether turning counts.
    pub mode: SweepMode,
    /// Whether the body is swept against dynamic bodies, or kinematic ones alone. True by default.
    pub include_dynamic: bool,
    /// Two bodies whose relative velocities are below both thresholds are not swept. In m/s, 0 by default.
    pub linear_threshold: Scalar,
    /// The threshold of turning, in rad/s, 0 by default.
    pub angular_threshold: Scalar,
}

impl Default for SweptCcd {
    fn default() -> Self {
        Self::NON_LINEAR
    }
}

impl SweptCcd {
    /// Sweeps without turning.
    pub const LINEAR: Self = Self::new_with_mode(SweepMode::Linear);

    /// Sweeps with turning.
    pub const NON_LINEAR: Self = Self::new_with_mode(SweepMode::NonLinear);

    /// Sweeps with a mode, against all bodies and at all velocities.
    pub const fn new_with_mode(mode: SweepMode) -> Self {
        Self { mode, include_dynamic: true, linear_threshold: 0.0, angular_threshold: 0.0 }
    }

    /// Sweeps only bodies that are faster against each other than one of the thresholds, in m/s and rad/s.
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

/// Which motion a body with [`SweptCcd`] is swept along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq, Clone)]
pub enum SweepMode {
    /// Translation. What turns fast may be missed.
    Linear,
    /// Translation and turning, which costs more.
    #[default]
    NonLinear,
}

#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
