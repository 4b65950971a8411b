//! A level that is loaded again gets the same bits as the first time, after any history.

use avian::{math::Vector, parry::shape::SharedShape, prelude::*};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.finish();
    app.cleanup();
    app
}

fn steps(app: &mut App, count: u32) {
    for _ in 0..count {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_millis(16));
        app.update();
    }
}

fn shape(number: usize) -> Collider {
    let mut corners = vec![Vector::ZERO];
    for axis in Vector::AXES {
        corners = corners.iter().flat_map(|c| [*c - axis * 0.4, *c + axis * 0.4]).collect();
    }
    match number % 3 {
        0 => SharedShape::ball(0.4).into(),
        1 => Collider::convex_hull(corners).expect("a box is convex"),
        _ => Collider::capsule(0.3, 0.4),
    }
}

/// A pile `columns` wide, some of whose bodies have a second collider below them.
fn pile(app: &mut App, columns: usize, layers: usize) -> Vec<Entity> {
    let spawn = |i: usize| {
        let (column, layer) = ((i % columns) as f32, (i / columns) as f32);
        let place = Transform::from_xyz(0.7 * column + 0.2 * (layer % 3.0), 0.6 + layer, 0.0);
        let world = app.world_mut();
        let body = world.spawn((RigidBody::Dynamic, shape(i), place)).id();
        if i.is_multiple_of(5) {
            world.spawn((Collider::capsule(0.2, 0.3), Transform::from_xyz(0.3, 0.2, 0.0), ChildOf(body)));
        }
        body
    };
    (0..columns * layers).map(spawn).collect()
}

fn floor(app: &mut App) -> Entity {
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y))).id()
}

fn state(app: &App, bodies: &[Entity]) -> Vec<String> {
    let of = |body: &Entity| {
        let body = app.world().entity(*body);
        let pose = (body.get::<Position>(), body.get::<Rotation>());
        // Floats are printed with enough digits to be unique.
        format!("{pose:?} {:?} {:?}", body.get::<LinearVelocity>(), body.get::<AngularVelocity>())
    };
    bodies.iter().map(of).collect()
}

/// Entities that stay when a level is unloaded.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kept {
    Nothing,
    Floor,
    /// Beside the floor a sensor without a body.
    FloorAndSensor,
}

#[test]
fn issue_a_level_loaded_again_came_to_other_bits() {
    for kept in [Kept::Nothing, Kept::Floor, Kept::FloorAndSensor] {
        let load = |app: &mut App| {
            if kept == Kept::FloorAndSensor {
                app.world_mut().spawn((Collider::half_space(Vector::Y), Sensor));
            }
            floor(app)
        };
        let mut first = app();
        load(&mut first);
        let bodies = pile(&mut first, 6, 6);
        steps(&mut first, 120);
        let expected = state(&first, &bodies);

        for (columns, layers, before, gap) in [(3, 4, 20, 0), (9, 5, 90, 0), (9, 5, 90, 1), (4, 9, 7, 30)] {
            let mut app = app();
            let mut level = load(&mut app);
            let old = pile(&mut app, columns, layers);
            steps(&mut app, before);
            // Neither in order nor in reverse.
            let (even, odd): (Vec<_>, Vec<_>) = old.iter().enumerate().partition(|(i, _)| i % 2 == 0);
            even.iter().rev().chain(&odd).for_each(|(_, body)| _ = app.world_mut().despawn(**body));
            if kept == Kept::Nothing {
                app.world_mut().despawn(level);
            }
            steps(&mut app, gap);
            if kept == Kept::Nothing {
                level = floor(&mut app);
            }
            assert!(app.world().get_entity(level).is_ok());
            let bodies = pile(&mut app, 6, 6);
            steps(&mut app, 120);
            let same = state(&app, &bodies) == expected;
            assert!(same, "{kept:?} kept, {columns} × {layers} bodies for {before} steps, {gap} between");
        }
    }
}
