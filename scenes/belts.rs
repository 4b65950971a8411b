//! Conveyor belts: static bodies whose surface moves.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::dim;
use crate::pile::{WIDTH, spawn_container};
use crate::scene::{at, set_conditions, spawn_body};

/// Speed of the belts in m/s.
pub const SPEED: f32 = 2.0;

/// Belts above each other that carry boxes to and fro, down to the floor.
pub fn belts(world: &mut World) {
    set_conditions(world);
    spawn_container(world, WIDTH, 14.0);
    for (i, y) in [2.5, 5.0, 7.5].into_iter().enumerate() {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let surface = FacetMaterial {
            friction: Friction::new(0.8),
            tangent_velocity: dim::vector(Vec3::X * side * SPEED),
            ..FacetMaterial::default()
        };
        // As long as the container is wide but for a gap that boxes fall through.
        spawn_body(world, RigidBody::Static, dim::belt(WIDTH - 4.0, 0.4, WIDTH), at(-2.0 * side, y, 0.0))
            .insert(FacetMaterials { materials: vec![surface], facets: vec![0] });
    }
    // One layer on the uppermost belt.
    for i in 0..8 {
        for lane in 0..dim::PILE_GRID.1.min(3) {
            let place = Vec3::new(0.95 * i as f32 - 5.4, 8.2, 3.0 * lane as f32 - 3.0) * dim::PLANE;
            spawn_body(world, RigidBody::Dynamic, dim::block(0.7, 0.7, 0.7), at(place.x, place.y, place.z));
        }
    }
}
