//! Fast bodies between thin walls: nothing gets out.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::dim;
use crate::numbers::Rng;
use crate::scene::{Glass, at, set_conditions, spawn_block, spawn_body};

/// Half the width of the box in metres, and thickness of its walls.
pub const BOX: (f32, f32) = (6.0, 0.02);
/// Speed of a bullet in m/s: 3.3 m in a step of 1/60 s.
pub const SPEED: f32 = 200.0;

/// A box of thin walls without gravity, with `count` bullets that bounce between them.
pub fn bullets(world: &mut World, count: u32) {
    set_conditions(world);
    world.insert_resource(Gravity::ZERO);
    let (far, thin) = BOX;
    // As thick as they are, the walls end where the next begins.
    let side = 2.0 * (far + thin);
    for x in [-far, far] {
        spawn_block(world, [thin, side, side], at(x, 0.0, 0.0));
        spawn_block(world, [side, thin, side], at(0.0, x, 0.0));
    }
    for (z, glass) in dim::walls_across(far) {
        let mut wall = spawn_block(world, [side, side, thin], at(0.0, 0.0, z));
        if glass {
            wall.insert(Glass);
        }
    }
    let mut rng = Rng::new(5);
    for i in 0..count {
        let mut coordinate = || rng.between(-1.0, 1.0);
        let way = Vec3::new(coordinate(), coordinate(), coordinate()) * dim::PLANE;
        let cell = Vec3::new((i % 10) as f32 - 4.5, (i / 10 % 10) as f32 - 4.5, 0.0);
        spawn_body(world, RigidBody::Dynamic, dim::ball(0.15), at(cell.x, cell.y, cell.z)).insert((
            LinearVelocity(dim::vector(way.normalize_or(Vec3::X) * SPEED)),
            Restitution::new(0.95).with_combine_rule(CoefficientCombine::Max),
        ));
    }
}
