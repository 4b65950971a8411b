//! A height field and a mesh: hills with a roof on them, and every shape poured over both.

use avian::prelude::*;
use bevy_ecs::prelude::*;

use crate::dim;
use crate::numbers::{Rng, sin_cos};
use crate::pile::{WIDTH, spawn_container, spawn_piece};
use crate::scene::{at, set_conditions, spawn_body};

/// Pours `layers` layers of bodies over hills between walls.
pub fn terrain(world: &mut World, layers: u32) {
    set_conditions(world);
    spawn_container(world, WIDTH, 10.0);
    // The outermost points are behind the walls.
    spawn_body(world, RigidBody::Static, dim::hills(WIDTH + 1.0, height), at(0.0, 0.0, 0.0));
    spawn_body(world, RigidBody::Static, dim::roof(3.0, 1.5), at(0.0, 2.6, 0.0));
    let mut rng = Rng::new(7);
    let (across, deep) = dim::PILE_GRID;
    for i in 0..layers * across * deep {
        let (column, row, layer) = (i % across, i / across % deep, i / (across * deep));
        let cell = |i: u32, n: u32| (i as f32 + 0.5 - 0.5 * n as f32) * (WIDTH - 1.0) / across as f32;
        let place = bevy_math::Vec3::new(cell(column, across), 5.5 + 1.6 * layer as f32, cell(row, deep));
        spawn_piece(world, i % dim::PIECES, place * dim::PLANE, rng.between(-3.0, 3.0));
    }
}

/// Height of the hills in metres, from 0.2 to 2.2.
fn height(x: f32, z: f32) -> f32 {
    1.2 + 0.5 * (sin_cos(1.1 * x).0 + sin_cos(0.9 * z + 0.5 * x).1)
}
