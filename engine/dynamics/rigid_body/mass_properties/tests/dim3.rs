//! Helpers of the tests in 3D. `dim2.rs` exports the same names.

use super::{AngularInertia, ComputedAngularInertia, Lump, UNIT_INERTIA};
use crate::math::{ComputeMassProperties, Scalar, VectorF32};

impl ComputeMassProperties for Lump {
    fn mass(&self, density: f32) -> f32 {
        density
    }
    fn unit_principal_angular_inertia(&self) -> VectorF32 {
        VectorF32::splat(UNIT_INERTIA)
    }
    fn center_of_mass(&self) -> VectorF32 {
        self.center
    }
}

pub(super) fn inertia(value: f32) -> AngularInertia {
    AngularInertia::new(VectorF32::splat(value))
}

/// Inertia about z, in kg·m².
pub(super) fn about_z(inertia: &ComputedAngularInertia) -> Scalar {
    inertia.value().m22
}
