//! Characters as games drive them: boxes that cannot turn, with a velocity into a wall of tiles that is set
//! in each tick.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::{TimePlugin, TimeUpdateStrategy, prelude::*};
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;

/// A box with the given half extents; all but the first two axes are as long as the first.
fn block(x: Scalar, y: Scalar) -> Collider {
    let mut corners = vec![Vector::ZERO];
    for (i, axis) in Vector::AXES.into_iter().enumerate() {
        let half = if i == 1 { y } else { x };
        corners = corners.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

/// The speed into the wall, in m/s.
#[derive(Component)]
struct Walks(Scalar);

fn walk(mut walkers: Query<(&Walks, &mut LinearVelocity)>) {
    walkers.iter_mut().for_each(|(walks, mut velocity)| velocity.x = walks.0);
}

/// The heights of two boxes, over that of their start, after some seconds: of one that is driven into a wall,
/// and of one beside it.
fn fall(rate: f64, speed: Scalar, upward: Scalar, seconds: f64) -> [Scalar; 2] {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()));
    app.insert_resource(Time::<Fixed>::from_hz(rate));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / rate)));
    app.insert_resource(DefaultFriction(Friction::ZERO));
    app.add_systems(FixedUpdate, walk);
    for k in -30..8 {
        app.world_mut().spawn((RigidBody::Static, block(0.5, 0.5), Transform::from_xyz(0.5, k as f32, 0.0)));
    }
    let bodies = [speed, 0.0].map(|speed| {
        let at = if speed > 0.0 { -0.4 } else { -5.0 };
        let place = Transform::from_xyz(at, 0.3, 0.0);
        let body = (RigidBody::Dynamic, block(0.4, 0.9), place, LockedAxes::ROTATION_LOCKED, Walks(speed));
        app.world_mut().spawn((body, LinearVelocity(Vector::Y * upward))).id()
    });
    (0..=(seconds * rate) as u32).for_each(|_| app.update());
    bodies.map(|body| app.world().get::<Position>(body).expect("it has one").y - 0.3)
}

/// They stopped at every seam: a fall of 20 m took up to 6.5 times as long, and a jump ended at a tenth
/// of its height.
#[test]
fn characters_fall_and_jump_along_walls_of_tiles_as_beside_them() {
    for rate in [30.0, 60.0, 144.0] {
        for speed in [1.0, 5.0, 10.0] {
            for (upward, seconds) in [(0.0, 2.0), (6.0, 0.6)] {
                let [driven, free] = fall(rate, speed, upward, seconds);
                let what = format!("{rate} Hz, {speed} m/s, {upward} m/s up: {driven} instead of {free}");
                assert!((driven / free - 1.0).abs() < 0.02, "{what}");
            }
        }
    }
}
