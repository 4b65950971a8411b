//! Many rays in one call, by one thread and by two: the caller, and one thread of Bevy's compute pool.

use bevy::{ecs::system::SystemState, prelude::*};

use crate::world::{app, median, milliseconds};

/// Number of rays.
const RAYS: usize = 100_000;

/// Number of rays in a call that the caller answers alone.
const FEW: usize = 256;

/// Number of times that all rays are cast.
const REPEATS: usize = 50;

/// Measures both dimensions.
pub fn measure() {
    for (dimension, [one, two]) in [("2D", flat()), ("3D", solid())] {
        let ratio = one / two;
        println!("{RAYS} rays, {dimension}: 1 thread {one:.2}, 2 threads {two:.2}, {ratio:.2} times as fast");
    }
}

/// Median times of all rays by one thread and by two, which take turns. `cast` casts rays in calls of a
/// given number.
fn one_and_two(mut cast: impl FnMut(usize)) -> [f64; 2] {
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..REPEATS {
        for (times, in_call) in times.iter_mut().zip([FEW, RAYS]) {
            times.push(milliseconds(|| cast(in_call)));
        }
    }
    times.map(median)
}

/// Numbers from 0 to 1, spread evenly.
fn spread(i: usize, factor: f64) -> f32 {
    (i as f64 * factor).fract() as f32
}

fn flat() -> [f64; 2] {
    use avian2d::prelude::*;
    let mut app = app(|app| {
        app.add_plugins(PhysicsPlugins::new(Update));
    });
    for i in 0..10_000 {
        let at = Transform::from_xyz((i % 100) as f32 * 3.0, (i / 100) as f32 * 3.0, 0.0)
            .with_rotation(Quat::from_rotation_z(i as f32));
        let collider = match i % 3 {
            0 => Collider::circle(0.4),
            1 => Collider::rectangle(0.8, 0.6),
            _ => Collider::capsule(0.3, 0.5),
        };
        app.world_mut().spawn((RigidBody::Static, collider, at));
    }
    app.update();
    let rays: Vec<_> = (0..RAYS)
        .map(|i| {
            let origin = Vec2::new(spread(i, 0.754_877_666), spread(i, 0.569_840_291)) * 300.0;
            let direction = Dir2::new(Vec2::from_angle(i as f32)).expect("it is not zero");
            (origin, direction)
        })
        .collect();
    let mut hits = vec![None; RAYS];
    let mut state = SystemState::<SpatialQuery>::new(app.world_mut());
    let queries = state.get(app.world_mut()).expect("the spatial query is there");
    one_and_two(|in_call| {
        for (rays, hits) in rays.chunks(in_call).zip(hits.chunks_mut(in_call)) {
            queries.cast_rays(rays, 30.0, true, &SpatialQueryFilter::default(), hits);
        }
    })
}

fn solid() -> [f64; 2] {
    use avian3d::prelude::*;
    let mut app = app(|app| {
        app.add_plugins(PhysicsPlugins::new(Update));
    });
    for i in 0..10_000 {
        let at = Vec3::new((i % 22) as f32, (i / 22 % 22) as f32, (i / 484) as f32) * 3.0;
        let at = Transform::from_translation(at).with_rotation(Quat::from_rotation_x(i as f32));
        let collider = match i % 3 {
            0 => Collider::sphere(0.4),
            1 => Collider::cuboid(0.8, 0.6, 1.0),
            _ => Collider::capsule(0.3, 0.5),
        };
        app.world_mut().spawn((RigidBody::Static, collider, at));
    }
    app.update();
    let rays: Vec<_> = (0..RAYS)
        .map(|i| {
            let [x, y, z] = [0.819_172_513, 0.671_043_607, 0.549_700_478].map(|factor| spread(i, factor));
            let turn =
                Quat::from_rotation_y(i as f32) * Quat::from_rotation_z(spread(i, 0.618_033_989) * 3.0);
            (Vec3::new(x, y, z) * 63.0, Dir3::new(turn * Vec3::Y).expect("it is not zero"))
        })
        .collect();
    let mut hits = vec![None; RAYS];
    let mut state = SystemState::<SpatialQuery>::new(app.world_mut());
    let queries = state.get(app.world_mut()).expect("the spatial query is there");
    one_and_two(|in_call| {
        for (rays, hits) in rays.chunks(in_call).zip(hits.chunks_mut(in_call)) {
            queries.cast_rays(rays, 30.0, true, &SpatialQueryFilter::default(), hits);
        }
    })
}
