//! Joints: a bridge of planks with boxes on it, and heavy balls on chains.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::dim;
use crate::scene::{at, set_conditions, spawn_block, spawn_body};

/// Length of a plank in metres, and the gap between two.
const PLANK: (f32, f32) = (0.8, 0.1);

/// A bridge of `planks` planks with boxes on it, and a chain with a ball at each end of it.
pub fn bridge(world: &mut World, planks: u32) {
    set_conditions(world);
    let (length, gap) = PLANK;
    let pitch = length + gap;
    let reach = 0.5 * pitch * planks as f32;
    spawn_block(world, [4.0 * reach, 1.0, 12.0], at(0.0, -0.5, 0.0));
    let [left, right] =
        [-reach - 0.2, reach + 0.2].map(|x| spawn_block(world, [0.4, 0.4, 2.0], at(x, 6.0, 0.0)).id());

    let mut last = left;
    for i in 0..planks {
        let x = (i as f32 + 0.5) * pitch - reach;
        let plank = dim::block(length, 0.2, 2.0);
        let plank = spawn_body(world, RigidBody::Dynamic, plank, at(x, 6.0, 0.0)).id();
        join(world, last, plank, Vec3::new(x - 0.5 * pitch, 6.0, 0.0));
        last = plank;
    }
    join(world, last, right, Vec3::new(reach, 6.0, 0.0));
    for i in 0..planks / 2 {
        let x = (2.0 * i as f32 + 1.0) * pitch - reach;
        spawn_body(world, RigidBody::Dynamic, dim::block(0.7, 0.7, 0.7), at(x, 7.0, 0.0));
    }

    for (side, post) in [(-1.0, left), (1.0, right)] {
        let mut last = post;
        // Level, so that the chain swings down.
        let mut joint = Vec3::new(side * (reach + 0.4), 6.0, 0.0);
        for _ in 0..6 {
            let middle = joint + Vec3::X * side * 0.25;
            let link = dim::block(0.4, 0.15, 0.15);
            let link = spawn_body(world, RigidBody::Dynamic, link, at(middle.x, middle.y, middle.z)).id();
            join(world, last, link, joint);
            (last, joint) = (link, joint + Vec3::X * side * 0.5);
        }
        let ball = spawn_body(world, RigidBody::Dynamic, dim::ball(0.8), at(joint.x + side * 0.8, 6.0, 0.0));
        let ball = ball.id();
        join(world, last, ball, joint);
    }
}

/// A hinge at a point of the world.
fn join(world: &mut World, body1: Entity, body2: Entity, point: Vec3) {
    let hinge = RevoluteJoint::new(body1, body2).with_anchor(dim::vector(point));
    world.spawn((hinge, JointCollisionDisabled));
}
