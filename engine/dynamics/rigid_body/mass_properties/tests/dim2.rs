//! Helpers of the tests in 2D. `dim3.rs` exports the same names.

use super::{AngularInertia, ComputedAngularInertia, Lump, UNIT_INERTIA};
use crate::math::{ComputeMassProperties, Scalar, VectorF32};

impl ComputeMassProperties for Lump {
    fn mass(&self, density: f32) -> f32 {
        density
    }
    fn unit_angular_inertia(&self) -> f32 {
        UNIT_INERTIA
    }
    fn center_of_mass(&self) -> VectorF32 {
        self.center
    }
}

pub(super) fn inertia(value: f32) -> AngularInertia {
    AngularInertia(value)
}

/// Inertia about z, in kg·m².
pub(super) fn about_z(inertia: &ComputedAngularInertia) -> Scalar {
    inertia.value()
}
