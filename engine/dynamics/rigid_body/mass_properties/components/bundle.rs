//! A bundle of mass properties.

use bevy_ecs::prelude::*;

use super::{AngularInertia, CenterOfMass, Mass};
use crate::math::ComputeMassProperties;

/// The mass properties of one entity, as a bundle.
#[derive(Bundle, Debug, Default, Clone, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct MassPropertiesBundle {
    /// Mass, in kg.
    pub mass: Mass,
    /// Angular inertia about the centre of mass, in kg·m².
    pub angular_inertia: AngularInertia,
    /// Centre of mass in the entity's frame, in metres.
    pub center_of_mass: CenterOfMass,
}

impl MassPropertiesBundle {
    /// The mass properties of a shape filled with a material of `density`, in kg/m³ (in 2D kg/m²).
    pub fn from_shape<T: ComputeMassProperties>(shape: &T, density: f32) -> Self {
        let mass = shape.mass(density);
        Self {
            mass: Mass(mass),
            angular_inertia: AngularInertia::from_shape(shape, mass),
            center_of_mass: CenterOfMass::from_shape(shape),
        }
    }
}
