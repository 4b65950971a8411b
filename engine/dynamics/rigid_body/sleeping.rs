//! The components and settings of sleep. A group of bodies that touch and have all rested for a while is put
//! to sleep together, and costs nothing until something wakes it; the engine's sleeping systems do that.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

/// Marks a body that sleeps. Inserting or removing it puts the body's whole island to sleep or wakes it.
///
/// Whatever falls asleep, by itself or so, stays where it is and keeps [`LinearVelocity`](super::LinearVelocity) and
/// [`AngularVelocity`](super::AngularVelocity): it wakes with them, so that a stack goes on as if it had not slept.
/// Setting another velocity wakes it, unless the marker is inserted in the same step.
///
/// A body's table row should not move whenever it falls asleep: the marker is stored apart, as a sparse set.
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

/// Keeps a body, and with it every island it is part of, from falling asleep. Inserting it wakes them.
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Debug, Default)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct SleepingDisabled;

/// The speeds below which a body counts as resting. A negative one keeps the body awake.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, PartialOrd)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct SleepThreshold {
    /// In m/s, scaled by the [`PhysicsLengthUnit`](crate::prelude::PhysicsLengthUnit). 0.15 by default.
    pub linear: f32,
    /// In rad/s. 0.15 by default.
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

/// How long a body has rested without a break, in seconds. Kept by the engine for bodies that are awake; setting it,
/// to 0 for instance, is as if the body had rested that long.
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

/// How long all bodies of an island must have rested before it falls asleep, in seconds. 0.5 by default.
/// However short, they must have rested for four steps.
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
