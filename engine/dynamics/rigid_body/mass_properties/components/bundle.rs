//! Mass properties to be spawned together.

use bevy_ecs::prelude::*;

use super::{AngularInertia, CenterOfMass, Mass};
use crate::math::ComputeMassProperties;

/// The mass properties of one entity, to be spawned together.
#[derive(Bundle, Debug, Default, Clone, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct MassPropertiesBundle {
    /// In kg.
    pub mass: Mass,
    /// In kg·m², about the centre of mass.
    pub angular_inertia: AngularInertia,
    /// In metres, in the entity's frame.
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
