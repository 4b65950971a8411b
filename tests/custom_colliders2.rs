//! Masses of the collider types of `custom_colliders.rs`.

use super::custom_colliders::{Globe, Liar};
use avian::prelude::ComputeMassProperties2d;
use bevy_transform::components::Transform;

/// A place in the plane x, y.
pub fn place(x: f32, y: f32) -> Transform {
    Transform::from_xyz(x, y, 0.0)
}

impl<const TYPE: usize> ComputeMassProperties2d for Globe<TYPE> {
    fn mass(&self, density: f32) -> f32 {
        self.ball().mass(density)
    }

    fn unit_angular_inertia(&self) -> f32 {
        self.ball().unit_angular_inertia()
    }

    fn center_of_mass(&self) -> bevy_math::Vec2 {
        self.ball().center_of_mass()
    }
}

impl ComputeMassProperties2d for Liar {
    fn mass(&self, density: f32) -> f32 {
        self.ball().mass(density)
    }

    fn unit_angular_inertia(&self) -> f32 {
        self.ball().unit_angular_inertia()
    }

    fn center_of_mass(&self) -> bevy_math::Vec2 {
        self.ball().center_of_mass()
    }
}
