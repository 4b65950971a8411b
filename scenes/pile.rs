//! A heap of every shape, poured into a container.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::Transform;

use crate::dim;
use crate::numbers::Rng;
use crate::scene::{Glass, at, set_conditions, spawn_block, turned};

/// Side length of the container in metres, inside.
pub const WIDTH: f32 = 12.0;

/// Pours `layers` layers of bodies, one body of each kind in turn, into a container of [`WIDTH`].
pub fn mixed(world: &mut World, layers: u32) {
    mixed_by_chance(world, layers, 42);
}

/// [`mixed`] with other places and angles for each `seed`.
pub fn mixed_by_chance(world: &mut World, layers: u32, seed: u64) {
    set_conditions(world);
    // Higher than the heap, so that no body rolls off.
    spawn_container(world, WIDTH, 12.0);
    let mut rng = Rng::new(seed);
    let (across, deep) = dim::PILE_GRID;
    let mut kind = 0;
    for layer in 0..layers {
        for row in 0..deep {
            for column in 0..across {
                let cell = |i: u32, n: u32| (i as f32 + 0.5 - 0.5 * n as f32) * (WIDTH - 1.0) / across as f32;
                let jitter = Vec3::new(rng.between(-0.05, 0.05), 0.0, rng.between(-0.05, 0.05));
                let place =
                    Vec3::new(cell(column, across), 1.5 + 1.6 * layer as f32, cell(row, deep)) + jitter;
                let angle = rng.between(-3.0, 3.0);
                spawn_piece(world, kind, place * dim::PLANE, angle);
                kind = (kind + 1) % dim::PIECES;
            }
        }
    }
}

/// One dynamic body of the given kind (below [`dim::PIECES`]), about a metre across, turned by `angle`.
pub fn spawn_piece(world: &mut World, kind: u32, place: Vec3, angle: f32) -> Entity {
    let pose = Transform::from_translation(place).with_rotation(turned(angle) * dim::piece_turn(angle));
    let parts = dim::piece(kind);
    let mut body = world.spawn((RigidBody::Dynamic, pose));
    body.with_children(|children| {
        for (collider, offset) in &parts[1..] {
            children.spawn((collider.clone(), ColliderDensity(dim::DENSITY), *offset));
        }
    });
    body.insert((parts[0].0.clone(), ColliderDensity(dim::DENSITY)));
    body.id()
}

/// A floor with walls around it: two in 2D, four in 3D, the nearest of glass.
pub fn spawn_container(world: &mut World, width: f32, height: f32) {
    let (outer, far) = (width + 2.0, 0.5 * width + 0.5);
    spawn_block(world, [outer, 1.0, outer], at(0.0, -0.5, 0.0));
    spawn_block(world, [1.0, height, outer], at(-far, 0.5 * height, 0.0));
    spawn_block(world, [1.0, height, outer], at(far, 0.5 * height, 0.0));
    for (z, glass) in dim::walls_across(far) {
        let mut wall = spawn_block(world, [width, height, 1.0], at(0.0, 0.5 * height, z));
        if glass {
            wall.insert(Glass);
        }
    }
}
