//! Wheels on springs, driven by motors.

use avian::prelude::*;
use bevy_ecs::prelude::*;

use crate::dim;
use crate::scene::{Glass, at, set_conditions, spawn_block, spawn_body};

/// Radius and width of a wheel in metres.
const WHEEL: (f32, f32) = (0.4, 0.3);
/// Length, height and width of a chassis in metres.
const CHASSIS: [f32; 3] = [2.4, 0.5, 1.2];
/// Half of the length of the road, in metres.
const REACH: f32 = 25.0;

/// Cars drive over bumps into stacks of boxes.
pub fn cars(world: &mut World, count: u32) {
    set_conditions(world);
    spawn_block(world, [2.0 * REACH + 2.0, 1.0, 16.0], at(0.0, -0.5, 0.0));
    for x in [-REACH - 0.5, REACH + 0.5] {
        spawn_block(world, [1.0, 6.0, 16.0], at(x, 3.0, 0.0));
    }
    for (z, glass) in dim::walls_across(8.5) {
        let mut wall = spawn_block(world, [2.0 * REACH, 3.0, 1.0], at(0.0, 1.5, z));
        if glass {
            wall.insert(Glass);
        }
    }
    for i in 0..5 {
        // A rounded kerb of ten centimetres.
        let pose = at(4.0 * i as f32 - 8.0, -0.9, 0.0).with_rotation(dim::roller_turn());
        spawn_body(world, RigidBody::Static, dim::roller(1.0, 14.0), pose);
    }
    for i in 0..3 * dim::PILE_GRID.1.min(4) {
        let (row, lane) = (i % 3, i / 3);
        let z = dim::PLANE.z * (3.6 * lane as f32 - 5.4);
        for column in 0..3 - row {
            let x = 15.0 + 0.9 * (column as f32 + 0.5 * row as f32);
            spawn_body(
                world,
                RigidBody::Dynamic,
                dim::block(0.8, 0.8, 0.8),
                at(x, 0.4 + 0.8 * row as f32, z),
            );
        }
    }
    for i in 0..count {
        let (column, lane) = (i / dim::PILE_GRID.1.min(4), i % dim::PILE_GRID.1.min(4));
        spawn_car(world, -REACH + 3.0 + 4.0 * column as f32, dim::PLANE.z * (3.6 * lane as f32 - 5.4));
    }
}

/// A box on wheels, of which there are two on each side.
fn spawn_car(world: &mut World, x: f32, z: f32) {
    let [length, height, width] = CHASSIS;
    let chassis =
        spawn_body(world, RigidBody::Dynamic, dim::block(length, height, width), at(x, 0.9, z)).id();
    let spring = MotorModel::SpringDamper { frequency: 3.0, damping_ratio: 0.7 };
    let engine = MotorModel::AccelerationBased { stiffness: 0.0, damping: 5.0 };
    let motor = AngularMotor::new(engine).with_target_velocity(-15.0).with_max_torque(100.0 * dim::DENSITY);
    for along in [-0.8, 0.8] {
        for aside in dim::wheels_across(0.5 * width + 0.5 * WHEEL.1 + 0.05) {
            let pose = at(x + along, 0.9 - 0.45, z + aside).with_rotation(dim::roller_turn());
            let wheel = spawn_body(world, RigidBody::Dynamic, dim::roller(WHEEL.0, WHEEL.1), pose)
                .insert(Friction::new(1.0))
                .id();
            let joint = dim::wheel(chassis, wheel, [along, -0.45, aside])
                .with_suspension(LinearMotor::new(spring))
                .with_suspension_limits(-0.15, 0.15)
                .with_motor(motor);
            world.spawn((joint, JointCollisionDisabled));
        }
    }
}
