//! Characters of this engine.

use std::time::Duration;

use bevy::{app::Plugins, prelude::*};

use super::{DT, SIDE, SIZE, STEPS, V, course::Part, height, hills, place, speed};
use crate::world::{app, median, milliseconds};

/// The places of a character in a part of the course, after each tick.
pub fn walk(part: &Part) -> Vec<V> {
    use avian3d::prelude::*;
    let mut app = app(|app| _ = app.add_plugins(PhysicsPlugins::new(Update)));
    let world = app.world_mut();
    for block in &part.blocks {
        let [x, y, z] = block.half.map(|half| 2.0 * half);
        let turn = Quat::from_rotation_y(block.turn[1]) * Quat::from_rotation_z(block.turn[0]);
        let at = Transform::from_translation(block.at.into()).with_rotation(turn);
        world.spawn((RigidBody::Static, Collider::cuboid(x, y, z), at));
    }
    let input = CharacterInput { velocity: part.velocity.into(), ..default() };
    let at = Transform::from_translation(part.start.into());
    let shape = Collider::capsule(SIZE[0], SIZE[1]);
    let character = world.spawn((CharacterController::default(), input, shape, at)).id();
    (0..(part.seconds / DT) as usize)
        .map(|_| {
            app.update();
            app.world().get::<Position>(character).expect("it is there").0.to_array()
        })
        .collect()
}

/// Median times of a step and of a part of it.
fn time<M>(
    plugins: impl Plugins<M>,
    spawn: impl FnOnce(&mut World),
    part: impl Fn(&World) -> Duration,
) -> [f64; 2] {
    let mut app = app(|app| _ = app.add_plugins(plugins));
    spawn(app.world_mut());
    part(app.world());
    (0..STEPS[0]).for_each(|_| app.update());
    let (mut steps, mut parts) = (Vec::new(), Vec::new());
    for _ in 0..STEPS[1] {
        steps.push(milliseconds(|| app.update()));
        parts.push(part(app.world()).as_secs_f64() * 1e3);
    }
    [steps, parts].map(median)
}

/// Times of a step of the crowd in 2D, and of its characters.
pub fn flat_crowd() -> [f64; 2] {
    use avian2d::{prelude::*, schedule::StepTimes};
    let part = |world: &World| {
        let parts = world.resource::<StepTimes>().parts();
        parts.filter(|(part, _)| *part == "MoveCharacters").map(|(_, time)| time).sum()
    };
    let spawn = |world: &mut World| {
        let corners = (-20..2068).map(|x| Vec2::new(x as f32, height(x as f32, 0.0)));
        world.spawn((RigidBody::Static, Collider::polyline(corners.collect(), None)));
        for i in 0..SIDE * SIDE {
            let x = 2.0 * i as f32;
            let input = CharacterInput { velocity: Vec2::X * speed(i), ..default() };
            let at = Transform::from_xyz(x, height(x, 0.0) + 1.2, 0.0);
            let shape = Collider::capsule(SIZE[0], SIZE[1]);
            world.spawn((CharacterController::default(), input, shape, at));
        }
    };
    time(PhysicsPlugins::new(Update), spawn, part)
}

/// Times of a step of the crowd, and of its characters.
pub fn crowd() -> [f64; 2] {
    use avian3d::{prelude::*, schedule::StepTimes};
    let part = |world: &World| {
        let parts = world.resource::<StepTimes>().parts();
        parts.filter(|(part, _)| *part == "MoveCharacters").map(|(_, time)| time).sum()
    };
    let spawn = |world: &mut World| {
        let (vertices, triangles) = hills();
        let vertices = vertices.into_iter().map(Vec3::from).collect();
        world.spawn((RigidBody::Static, Collider::trimesh(vertices, triangles)));
        for i in 0..SIDE * SIDE {
            let input = CharacterInput { velocity: Vec3::X * speed(i), ..default() };
            let at = Transform::from_translation(place(i).into());
            let shape = Collider::capsule(SIZE[0], SIZE[1]);
            world.spawn((CharacterController::default(), input, shape, at));
        }
    };
    time(PhysicsPlugins::new(Update), spawn, part)
}
