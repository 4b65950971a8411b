//! Components and settings of sleeping. An island, a group of touching bodies, falls asleep when all its
//! bodies have rested for a while. A sleeping island costs nothing until it wakes.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

/// Marks a sleeping body. Inserting or removing it puts the body's island to sleep or wakes it.
///
/// A sleeping body keeps its pose, [`LinearVelocity`](super::LinearVelocity) and
/// [`AngularVelocity`](super::AngularVelocity), and wakes with these velocities: a stack continues as if it
/// had not slept. Setting another velocity wakes the body, unless the marker is inserted in the same step.
///
/// The marker has sparse-set storage: falling asleep does not move the body to another table.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn count_awake(bodies: Query<&RigidBody, Without<Sleeping>>) -> usize {
///     bodies.iter().filter(|body| body.is_dynamic()).count()
/// }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Debug, Default, PartialEq)]
#[component(storage = "SparseSet")]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct Sleeping;

/// Prevents a body and its whole island from falling asleep. Inserting the component wakes the island.
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Debug, Default)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct SleepingDisabled;

/// Speeds below which a body counts as at rest. A negative speed keeps the body awake.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, PartialOrd)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct SleepThreshold {
    /// Linear speed in m/s, scaled by the [`PhysicsLengthUnit`](crate::prelude::PhysicsLengthUnit).
    /// 0.15 by default.
    pub linear: f32,
    /// Angular speed in rad/s. 0.15 by default.
    pub angular: f32,
}

impl Default for SleepThreshold {
    fn default() -> Self {
        Self { linear: 0.15, angular: 0.15 }
    }
}

/// The former name of [`SleepThreshold`].
#[deprecated(since = "0.4.0", note = "renamed to `SleepThreshold`")]
pub type SleepingThreshold = SleepThreshold;

/// The time for which a body has been at rest, in seconds. The engine updates it for awake bodies. An app may
/// set it, for instance to 0.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct SleepTimer(pub f32);

/// The former name of [`SleepTimer`].
#[deprecated(since = "0.4.0", note = "renamed to `SleepTimer`")]
pub type TimeSleeping = SleepTimer;

/// The time for which all bodies of an island must rest before the island falls asleep, in seconds. 0.5 by
/// default. The minimum is four steps.
#[derive(Resource, Reflect, Clone, Copy, Debug, Deref, DerefMut, PartialEq, PartialOrd, From)]
#[reflect(Resource, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct TimeToSleep(pub f32);

impl Default for TimeToSleep {
    fn default() -> Self {
        Self(0.5)
    }
}

/// The former name of [`TimeToSleep`].
#[deprecated(since = "0.4.0", note = "renamed to `TimeToSleep`")]
pub type DeactivationTime = TimeToSleep;
