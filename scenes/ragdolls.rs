//! Ragdolls: humans of capsules, with limits at their joints.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::dim;
use crate::numbers::Rng;
use crate::pile::{WIDTH, spawn_container};
use crate::scene::{at, set_conditions, spawn_block, turned, yawed};

/// Ragdolls that fall down a flight of stairs between walls.
pub fn ragdolls(world: &mut World, layers: u32) {
    set_conditions(world);
    spawn_container(world, WIDTH, 14.0);
    for i in 0..6 {
        let height = 0.6 * (6 - i) as f32;
        spawn_block(world, [1.0, height, WIDTH], at(i as f32 + 0.5 - 0.5 * WIDTH, 0.5 * height, 0.0));
    }
    let (across, mut rng) = (3, Rng::new(5));
    let deep = dim::PILE_GRID.1.min(3);
    for i in 0..layers * across * deep {
        let (column, row, layer) = (i % across, i / across % deep, i / (across * deep));
        let place = Vec3::new(3.0 * column as f32 - 4.0, 6.0 + 2.6 * layer as f32, 3.0 * row as f32 - 3.0);
        let turn = turned(rng.between(-0.5, 0.5)) * yawed(rng.between(-3.0, 3.0) * dim::PLANE.z);
        let place = place * dim::PLANE;
        let pose = at(place.x, place.y, place.z).with_rotation(turn);
        HumanRagdoll::default().spawn(&mut world.commands(), pose);
    }
    world.flush();
}
