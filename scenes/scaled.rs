//! Colliders scaled by their `Transform`: a level of one block, stretched to ramps, and pieces that are
//! scaled unevenly.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::dim;
use crate::numbers::Rng;
use crate::pile::{WIDTH, spawn_container};
use crate::scene::{at, set_conditions, spawn_block, spawn_body, turned};

/// Ramps above each other, and stretched balls and boxes that roll down.
pub fn scaled(world: &mut World) {
    set_conditions(world);
    spawn_container(world, WIDTH, 22.0);
    for (i, y) in [3.0, 7.0, 11.0].into_iter().enumerate() {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let ramp = at(-1.6 * side, y, 0.0).with_rotation(turned(-0.35 * side)).with_scale(Vec3::new(
            WIDTH - 4.0,
            0.4,
            WIDTH - 0.1,
        ));
        let slippery = Friction::new(0.1).with_combine_rule(CoefficientCombine::Min);
        spawn_block(world, [1.0, 1.0, 1.0], ramp).insert(slippery);
    }
    let mut rng = Rng::new(11);
    for i in 0..24 {
        let (column, row) = (i % 6, i / 6);
        let scale = Vec3::new(rng.between(0.4, 1.2), rng.between(0.4, 1.2), rng.between(0.4, 1.2));
        let place = Vec3::new(1.5 * column as f32 - 4.5, 14.5 + 1.5 * row as f32, 0.8 * row as f32 - 2.0);
        let place = place * dim::PLANE;
        let shape = if i % 2 == 0 { dim::ball(0.5) } else { dim::block(1.0, 1.0, 1.0) };
        spawn_body(world, RigidBody::Dynamic, shape, at(place.x, place.y, place.z).with_scale(scale));
    }
}
