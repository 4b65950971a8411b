//! Characters that walk to and fro.

use avian::prelude::*;
use bevy_app::FixedUpdate;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::Schedules;
use bevy_math::Vec3;

use crate::dim;
use crate::scene::{Glass, at, set_conditions, spawn_block, spawn_body, turned};

/// Half of the length of the way, in metres.
const REACH: f32 = 12.0;
/// Height and length of a step in metres.
const STEP: [f32; 2] = [0.25, 0.4];
/// Speed of the walkers in m/s.
const SPEED: f32 = 3.0;

/// A capsule, a cylinder and a box walk over stairs and a ramp, and push light boxes.
pub fn walkers(world: &mut World) {
    set_conditions(world);
    spawn_block(world, [2.0 * REACH + 2.0, 1.0, 13.0], at(0.0, -0.5, 0.0));
    for x in [-REACH - 0.5, REACH + 0.5] {
        spawn_block(world, [1.0, 5.0, 13.0], at(x, 2.5, 0.0));
    }
    for (z, glass) in dim::walls_across(7.0) {
        let mut wall = spawn_block(world, [2.0 * REACH, 5.0, 1.0], at(0.0, 2.5, z));
        if glass {
            wall.insert(Glass);
        }
    }
    let [rise, tread] = STEP;
    let steps = 6;
    for i in 0..steps {
        let height = rise * (i + 1) as f32;
        let x = -6.0 + tread * i as f32;
        spawn_block(world, [tread, height, 13.0], at(x, 0.5 * height, 0.0));
    }
    let top = rise * steps as f32;
    let (left, right) = (-6.0 + tread * (steps as f32 - 0.5), 1.0);
    spawn_block(world, [right - left, top, 13.0], at(0.5 * (left + right), 0.5 * top, 0.0));
    // Down at 20 degrees, its upper edge at that of the platform.
    let (angle, length) = (-0.349_f32, top / 0.342);
    let ramp = Vec3::new(right + 0.47 * length, 0.5 * top, 0.0) - Vec3::new(0.171, 0.47, 0.0);
    spawn_block(world, [length, 1.0, 13.0], at(ramp.x, ramp.y, ramp.z).with_rotation(turned(angle)));
    for i in 0..dim::PILE_GRID.1.min(3) {
        let z = dim::PLANE.z * (4.0 * i as f32 - 4.0);
        spawn_body(world, RigidBody::Dynamic, dim::block(0.6, 0.6, 0.6), at(8.5, 0.3, z));
    }
    let shapes = [dim::block(0.5, 1.6, 0.5), Collider::capsule(0.3, 1.0), dim::roller(0.4, 1.6)];
    for (i, shape) in shapes.into_iter().enumerate() {
        // In 2D characters walk in one plane: they meet, and turn round.
        let place = Vec3::new(-10.0 + 9.0 * i as f32, 2.6, 4.0 * i as f32 - 4.0) * dim::PLANE;
        let velocity = dim::vector(Vec3::X * SPEED);
        world
            .spawn((CharacterController::default(), shape, at(place.x, place.y, place.z)))
            .insert((CharacterInput { velocity, ..CharacterInput::default() }, Held::default()))
            .observe(turn_round);
    }
    world.resource_mut::<Schedules>().add_systems(FixedUpdate, (turn_back, turn_held));
}

/// How long a character has been held, in ticks.
#[derive(Component, Default)]
struct Held(u32);

/// Turns a character round that another one holds, with a box between them.
fn turn_held(mut walkers: Query<(&LinearVelocity, &mut CharacterInput, &mut Held)>) {
    for (velocity, mut input, mut held) in &mut walkers {
        held.0 = if velocity.length() < 0.1 * SPEED { held.0 + 1 } else { 0 };
        if held.0 == 30 {
            input.velocity = -input.velocity;
            held.0 = 0;
        }
    }
}

/// Two characters that meet walk apart.
fn turn_round(hit: On<CharacterHit>, mut inputs: Query<&mut CharacterInput>) {
    let Ok([mut one, mut other]) = inputs.get_many_mut([hit.character, hit.collider]) else { return };
    let apart = dim::vector(Vec3::X * SPEED.copysign(hit.normal.x));
    if one.velocity.dot(other.velocity) <= 0.0 {
        (one.velocity, other.velocity) = (apart, -apart);
    }
}

/// Turns characters round two metres before the walls.
fn turn_back(mut walkers: Query<(&Position, &mut CharacterInput)>) {
    for (position, mut input) in &mut walkers {
        if position.x.abs() > REACH - 2.0 && position.x * input.velocity.x > 0.0 {
            input.velocity = -input.velocity;
        }
    }
}
