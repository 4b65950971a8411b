//! Worlds that are timed frame by frame.

use std::time::{Duration, Instant};

use avian3d::prelude::*;
use bevy::{
    app::{TaskPoolOptions, TaskPoolPlugin},
    prelude::*,
    time::{TimePlugin, TimeUpdateStrategy},
};

/// Number of frames that are timed.
const FRAMES: usize = 300;

/// An app that takes one step of 1/60 s in each frame. Bevy's compute pool has one thread, beside
/// the main thread.
pub fn app(plugins: impl FnOnce(&mut App)) -> App {
    let task_pools = TaskPoolPlugin { task_pool_options: TaskPoolOptions::with_num_threads(1) };
    let mut app = App::new();
    app.add_plugins((task_pools, TimePlugin, TransformPlugin))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 60.0)));
    plugins(&mut app);
    app.finish();
    app.cleanup();
    app
}

/// Boxes that touch the floor and the next box, so that there are about twice as many pairs as boxes. They do
/// not sleep. `with` adds to each box.
pub fn boxes<B: Bundle>(count: usize, plugins: impl FnOnce(&mut App), with: impl Fn() -> B) -> App {
    let mut app = app(|app| {
        app.add_plugins(PhysicsPlugins::new(Update));
        plugins(app);
    });
    let floor = Collider::cuboid(2000.0, 1.0, 2000.0);
    app.world_mut().spawn((RigidBody::Static, floor, Transform::from_xyz(0.0, -0.5, 0.0)));
    for i in 0..count {
        let (row, place) = (i / 100, i % 100);
        let at = Transform::from_xyz(0.9999 * place as f32, 0.5, 2.0 * row as f32);
        let body = (RigidBody::Dynamic, Collider::cuboid(1.0, 1.0, 1.0), SleepingDisabled);
        app.world_mut().spawn((body, at, with()));
    }
    for _ in 0..60 {
        app.update();
    }
    app
}

/// Calls `frame` for each app in turn.
pub fn in_turn<const N: usize>(mut apps: [&mut App; N], mut frame: impl FnMut(usize, &mut App)) {
    for _ in 0..FRAMES {
        apps.iter_mut().enumerate().for_each(|(i, app)| frame(i, app));
    }
}

/// Median times of a frame of some apps, which take turns.
pub fn time<const N: usize>(apps: [&mut App; N]) -> [f64; N] {
    let mut times: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    in_turn(apps, |i, app| times[i].push(milliseconds(|| app.update())));
    times.map(median)
}

/// The time that a call takes.
pub fn milliseconds(call: impl FnOnce()) -> f64 {
    let start = Instant::now();
    call();
    start.elapsed().as_secs_f64() * 1e3
}

/// The value in the middle.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
