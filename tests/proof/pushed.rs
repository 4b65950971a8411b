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

/// The value that is set, and the frame in which it is set.
#[derive(Resource, Clone, Copy)]
struct Shot {
    ball: Entity,
    frame: usize,
    velocity: Vector,
}

fn shoot(shot: Res<Shot>, mut frame: Local<usize>, mut balls: Query<&mut LinearVelocity>) {
    if *frame == shot.frame {
        balls.get_mut(shot.ball).expect("the ball is there").0 = shot.velocity;
    }
    *frame += 1;
}

/// An app with frames of 1/144 s and physics at 64 Hz.
fn app() -> App {
    let mut app = scenes::headless_app(1.0 / 64.0, 6);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 144.0)));
    app.insert_resource(Time::<bevy_time::Fixed>::from_hz(64.0));
    app.insert_resource(Gravity(Vector::ZERO));
    app
}

/// Whether a ball passes a wall of 2 cm when it is shot at it from rest.
fn passes(speed: f32, k: usize, asleep: bool) -> bool {
    let mut app = app();
    let world = app.world_mut();
    world.spawn((RigidBody::Static, dim::sized_block(0.02, 4.0, 4.0), at(0.0, 0.0, 0.0)));
    let gap = speed / 64.0 * (k as f32 + 0.5) / 20.0;
    let place = at(-(0.01 + RADIUS + gap), 0.0, 0.0);
    let ball = world.spawn((RigidBody::Dynamic, scenes::dim::ball(RADIUS), place)).id();
    if !asleep {
        world.entity_mut(ball).insert(SleepingDisabled);
    }
    let frame = if asleep { 200 } else { 20 } + k;
    let velocity = Vector::X * Scalar::from(speed);
    world.insert_resource(Shot { ball, frame, velocity });
    app.add_systems(Update, shoot);
    for _ in 0..frame {
        app.update();
    }
    assert_eq!(app.world().get::<Sleeping>(ball).is_some(), asleep, "it sleeps if it may");
    for _ in 0..40 {
        app.update();
    }
    let place = app.world().get::<Position>(ball).expect("it is there").x;
    let start = -Scalar::from(0.01 + RADIUS + gap);
    assert!(place > start + 0.5 * Scalar::from(gap), "the ball was shot: it went from {start} to {place}");
    place > 0.0
}

#[test]
fn a_resting_or_sleeping_ball_that_the_app_shoots_at_a_thin_wall_hits_it() {
    for asleep in [false, true] {
        for speed in [10.0, 20.0, 60.0] {
            let passed = (0..20).filter(|k| passes(speed, *k, asleep)).count();
            assert_eq!(passed, 0, "of 20 pass at {speed} m/s, asleep: {asleep}");
        }
    }
}
