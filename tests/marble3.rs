//! The mass of the collider type that `plugins.rs` makes.

use super::plugins::Marble;
use avian::prelude::ComputeMassProperties3d;

impl ComputeMassProperties3d for Marble {
    fn mass(&self, density: f32) -> f32 {
        self.0.mass(density)
    }

    fn unit_principal_angular_inertia(&self) -> bevy_math::Vec3 {
        self.0.unit_principal_angular_inertia()
    }

    fn center_of_mass(&self) -> bevy_math::Vec3 {
        self.0.center_of_mass()
    }
}
