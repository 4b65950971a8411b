//! Joints that break: a wall of bricks, and what is thrown at it.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::dim;
use crate::scene::{at, set_conditions, spawn_block, spawn_body};

/// Length, height and thickness of a brick in metres.
const BRICK: [f32; 3] = [0.6, 0.4, 1.0];
/// How many bricks are above each other, and beside each other in 3D.
const HEIGHT: usize = 12;
/// The force at which a joint breaks, in weights of a brick.
const STRENGTH: f32 = 60.0;

/// Three balls fly at a wall, one after the other.
pub fn breaking(world: &mut World) {
    set_conditions(world);
    spawn_block(world, [40.0, 1.0, 16.0], at(0.0, -0.5, 0.0));
    let weight = BRICK[0] * BRICK[1] * if dim::PLANE.z > 0.0 { BRICK[2] } else { 1.0 } * dim::DENSITY * 10.0;
    let wide = dim::PILE_GRID.1 as usize;
    let mut bricks: Vec<(Entity, Vec3)> = Vec::new();
    for i in 0..HEIGHT * wide {
        let (row, column) = (i / wide, i % wide);
        let aside = column as f32 - 0.5 * (wide - 1) as f32;
        let place = Vec3::new(0.0, BRICK[1] * (row as f32 + 0.5), BRICK[2] * aside);
        let shape = dim::block(BRICK[0], BRICK[1], BRICK[2]);
        let brick = spawn_body(world, RigidBody::Dynamic, shape, at(place.x, place.y, place.z)).id();
        let beside = (column > 0).then(|| bricks[i - 1]);
        let below = (row > 0).then(|| bricks[i - wide]);
        for (other, at) in beside.into_iter().chain(below) {
            let joint = FixedJoint::new(other, brick).with_anchor(dim::vector(0.5 * (at + place)));
            let threshold = JointBreakThreshold::force(STRENGTH * weight);
            world.spawn((joint, threshold, JointCollisionDisabled)).observe(despawn);
        }
        bricks.push((brick, place));
    }
    for (x, y) in [(-8.0, 2.5), (-13.0, 3.5), (-18.0, 4.5)] {
        let mut ball = spawn_body(world, RigidBody::Dynamic, dim::ball(0.5), at(x, y, 0.0));
        ball.insert((ColliderDensity(5.0 * dim::DENSITY), LinearVelocity(dim::vector(Vec3::X * 12.0))));
    }
}

fn despawn(broken: On<JointBroken>, mut commands: Commands) {
    commands.entity(broken.joint).despawn();
}
