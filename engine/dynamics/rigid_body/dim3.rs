//! The body components whose shape is that of space. `dim2.rs` is the twin.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

use crate::math::Vector;

/// How fast a body turns, in rad/s about each of the world's axes, right-handed.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct AngularVelocity(pub Vector);

crate::type_path::type_path!(AngularVelocity, "dynamics::rigid_body");

impl AngularVelocity {
    /// Not turning.
    pub const ZERO: AngularVelocity = AngularVelocity(Vector::ZERO);
}
