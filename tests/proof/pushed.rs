//! Velocities set by the app take effect in the next step, without tunnelling.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::{App, Update};
use bevy_ecs::prelude::*;
use bevy_time::{Time, TimeUpdateStrategy};
use core::time::Duration;
use scenes::scene::at;

use super::dim;

const RADIUS: f32 = 0.1;

/// The velocity that a ball is given, and the frame in which it is.
#[derive(Component, Clone, Copy)]
struct Shot {
    frame: usize,
    velocity: Vector,
}

fn shoot(mut frame: Local<usize>, mut balls: Query<(&Shot, &mut LinearVelocity)>) {
    for (shot, mut velocity) in &mut balls {
        if *frame == shot.frame {
            velocity.0 = shot.velocity;
        }
    }
    *frame += 1;
}

/// An app with frames of 1/144 s and physics at 64 Hz.
fn app() -> App {
    let mut app = scenes::headless_app(1.0 / 64.0, 6);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 144.0)));
    app.insert_resource(Time::<bevy_time::Fixed>::from_hz(64.0));
    app.insert_resource(Gravity(Vector::ZERO));
    app.add_systems(Update, shoot);
    app
}

/// The number of balls, each with a wall of its own.
const BALLS: usize = 20;

/// How many balls pass a wall of 2 cm when each is shot from rest in another frame and from another distance.
fn passing(speed: f32, asleep: bool) -> usize {
    let mut app = app();
    let world = app.world_mut();
    let first = if asleep { 200 } else { 20 };
    let balls: Vec<(Entity, f32)> = (0..BALLS)
        .map(|k| {
            let height = 10.0 * k as f32;
            world.spawn((RigidBody::Static, dim::sized_block(0.02, 4.0, 4.0), at(0.0, height, 0.0)));
            let gap = speed / 64.0 * (k as f32 + 0.5) / BALLS as f32;
            let shot = Shot { frame: first + k, velocity: Vector::X * Scalar::from(speed) };
            let place = at(-(0.01 + RADIUS + gap), height, 0.0);
            let ball = world.spawn((RigidBody::Dynamic, scenes::dim::ball(RADIUS), place, shot)).id();
            if !asleep {
                world.entity_mut(ball).insert(SleepingDisabled);
            }
            (ball, gap)
        })
        .collect();
    for _ in 0..first {
        app.update();
    }
    for (ball, _) in &balls {
        assert_eq!(app.world().get::<Sleeping>(*ball).is_some(), asleep, "it sleeps if it may");
    }
    for _ in 0..BALLS + 40 {
        app.update();
    }
    let passed = |(ball, gap): &(Entity, f32)| {
        let place = app.world().get::<Position>(*ball).expect("it is there").x;
        let start = -Scalar::from(0.01 + RADIUS + gap);
        assert!(
            place > start + 0.5 * Scalar::from(*gap),
            "the ball was shot: it went from {start} to {place}"
        );
        place > 0.0
    };
    balls.iter().filter(|ball| passed(ball)).count()
}

#[test]
fn a_resting_or_sleeping_ball_that_the_app_shoots_at_a_thin_wall_hits_it() {
    for asleep in [false, true] {
        for speed in [10.0, 20.0, 60.0] {
            assert_eq!(passing(speed, asleep), 0, "of {BALLS} pass at {speed} m/s, asleep: {asleep}");
        }
    }
}
