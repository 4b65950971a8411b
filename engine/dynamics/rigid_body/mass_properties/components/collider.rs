//! Mass properties of colliders.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

use crate::math::{ComputeMassProperties, MassProperties};

/// The density of a collider, in kg/m³ (in 2D kg/m²). 1 by default. With 0 the collider has no mass.
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
    /// No mass.
    pub const ZERO: Self = Self(0.0);
}

/// The mass properties of a collider with its [`ColliderDensity`], in the collider's frame. They are computed
/// from the shape, and writing the component has no lasting effect. To set a mass, insert a
/// [`Mass`](super::Mass).
///
/// Sensors and disabled colliders also have the component, but their mass does not count for the body.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, PartialEq, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ColliderMassProperties(MassProperties);

impl ColliderMassProperties {
    /// No mass.
    pub const ZERO: Self = Self(MassProperties::ZERO);

    /// The mass properties of a shape filled with a material of `density`, in kg/m³ (in 2D kg/m²).
    pub fn from_shape<T: ComputeMassProperties>(shape: &T, density: f32) -> Self {
        Self(shape.mass_properties(density))
    }
}
