//! In double precision, simulation at a hundred kilometres from the origin is as good as at the origin.

use avian::{math::Vector, prelude::*};
use bevy_app::{App, TaskPoolPlugin};
use bevy_ecs::prelude::*;
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use core::time::Duration;

/// Steps of 1/60 s in 4 substeps, and a floor whose top is at `origin`.
fn app(origin: Vector, floor: Collider) -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()));
    app.insert_resource(Time::<Fixed>::from_duration(Duration::from_secs_f64(1.0 / 60.0)));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app.insert_resource(SubstepCount(4));
    app.finish();
    app.cleanup();
    app.world_mut().spawn((RigidBody::Static, floor, Position(origin - Vector::Y), Rotation::default()));
    app.update();
    app
}

/// Drops `bodies` and runs ten seconds. Returns positions relative to `origin`, speeds, and the number of
/// sleeping bodies.
fn drop_all(origin: Vector, floor: Collider, bodies: &[(Collider, Vector)]) -> (Vec<Vector>, f64, usize) {
    let mut app = app(origin, floor);
    let world = app.world_mut();
    let bodies: Vec<Entity> = bodies
        .iter()
        .map(|(collider, place)| {
            world
                .spawn((RigidBody::Dynamic, collider.clone(), Position(origin + *place), Rotation::default()))
                .id()
        })
        .collect();
    for _ in 0..600 {
        app.update();
    }
    let world = app.world();
    let component = |e: Entity| world.entity(e);
    let places =
        bodies.iter().map(|&e| component(e).get::<Position>().expect("a position").0 - origin).collect();
    let speed = |e: &Entity| component(*e).get::<LinearVelocity>().expect("a velocity").length();
    let asleep = bodies.iter().filter(|&&e| component(e).contains::<Sleeping>()).count();
    (places, bodies.iter().map(speed).fold(0.0, f64::max), asleep)
}

/// A hundred kilometres along two axes.
fn far() -> Vector {
    (Vector::X - Vector::Y) * 100_000.0
}

/// A tower of eight boxes stands at 1, 10 and 100 km as at the origin.
pub fn a_tower_stands(floor: Collider, unit_box: Collider) {
    let tower: Vec<_> = (0..8).map(|i| (unit_box.clone(), Vector::Y * (0.5 + f64::from(i)))).collect();
    let (here, ..) = drop_all(Vector::ZERO, floor.clone(), &tower);
    for share in [0.01, 0.1, 1.0] {
        let (there, _, asleep) = drop_all(far() * share, floor.clone(), &tower);
        assert_eq!(asleep, tower.len(), "it sleeps");
        for (here, there) in here.iter().zip(&there) {
            assert!((*here - *there).length() < 1e-3, "{here:?} here is {there:?} at {}", far() * share);
        }
    }
}

/// A heap of boxes falls and rests as at the origin.
pub fn a_heap_falls_and_rests(floor: Collider, unit_box: Collider) {
    let heap: Vec<_> = (0..40)
        .map(|i| {
            let (column, row) = (f64::from(i % 5), f64::from(i / 5));
            let place = Vector::X * (1.3 * column + 0.37 * row - 3.0) + Vector::Y * (1.0 + 1.2 * row);
            (unit_box.clone(), place)
        })
        .collect();
    let height = |places: &[Vector]| places.iter().map(|p| p.y).sum::<f64>() / places.len() as f64;
    let (here, speed_here, _) = drop_all(Vector::ZERO, floor.clone(), &heap);
    let (there, speed_there, _) = drop_all(far(), floor, &heap);
    // What falls asleep keeps the speed that it had, up to the threshold of sleep.
    assert!(speed_here < 0.15 && speed_there < 0.15, "{speed_here} and {speed_there} m/s after ten seconds");
    assert!(there.iter().all(|p| p.y > 0.45 && p.length() < 40.0), "{there:?}");
    let (here, there) = (height(&here), height(&there));
    assert!((here - there).abs() < 0.1 * here, "mean height {here} here, {there} there");
}

/// Free fall is exact: displacements are relative to the start.
pub fn free_fall_is_exact(floor: Collider, unit_box: Collider) {
    let mut app = app(far(), floor);
    let start = far() + Vector::Y * 500.0;
    let body =
        app.world_mut().spawn((RigidBody::Dynamic, unit_box, Position(start), Rotation::default())).id();
    for _ in 0..300 {
        app.update();
    }
    let (t, h) = (5.0, 1.0 / 240.0);
    let want = -0.5 * 9.81 * t * (t + h);
    let got = app.world().get::<Position>(body).expect("a position").0 - start;
    assert!((got.y - want).abs() < 1e-5 * want.abs() && got.x.abs() < 1e-9, "{got:?}, not {want}");
}
