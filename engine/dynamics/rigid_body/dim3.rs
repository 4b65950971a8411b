//! Body components of 3D. `dim2.rs` exports the same names.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

use crate::math::Vector;

/// Angular velocity of a body, in rad/s about each of the world's axes, right-handed.
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
    /// No rotation.
    pub const ZERO: AngularVelocity = AngularVelocity(Vector::ZERO);
}
