//! What colliders bring to their body's mass.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

use crate::math::{ComputeMassProperties, MassProperties};

/// The density of a collider's material, in kg/m³ (in 2D kg/m²). 1 by default; with 0 the collider weighs
/// nothing.
#[derive(Component, Reflect, Clone, Copy, Debug, Deref, DerefMut, PartialEq, PartialOrd, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ColliderDensity(pub f32);

impl Default for ColliderDensity {
    fn default() -> Self {
        Self(1.0)
    }
}

impl ColliderDensity {
    /// Weighs nothing.
    pub const ZERO: Self = Self(0.0);
}

/// What a collider of its [`ColliderDensity`] weighs, in the collider's frame. Computed from the shape; writing
/// it has no lasting effect. To give an entity another mass, insert a [`Mass`](super::Mass).
///
/// Of sensors and disabled colliders it is the same, but their body does not count it.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, PartialEq, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ColliderMassProperties(MassProperties);

impl ColliderMassProperties {
    /// Weighs nothing.
    pub const ZERO: Self = Self(MassProperties::ZERO);

    /// The mass properties of a shape filled with a material of `density`, in kg/m³ (in 2D kg/m²).
    pub fn from_shape<T: ComputeMassProperties>(shape: &T, density: f32) -> Self {
        Self(shape.mass_properties(density))
    }
}
