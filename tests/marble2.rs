//! The mass of the collider type that `plugins.rs` makes.

use super::plugins::Marble;
use avian::prelude::ComputeMassProperties2d;

impl ComputeMassProperties2d for Marble {
    fn mass(&self, density: f32) -> f32 {
        self.0.mass(density)
    }

    fn unit_angular_inertia(&self) -> f32 {
        self.0.unit_angular_inertia()
    }

    fn center_of_mass(&self) -> bevy_math::Vec2 {
        self.0.center_of_mass()
    }
}
