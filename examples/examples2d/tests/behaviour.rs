//! Examples do what they say, by numbers.

#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/collision_events.rs"]
mod collision_events;
#[path = "../../headless.rs"]
mod headless;
#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/moving_platform.rs"]
mod moving_platform;
#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/player.rs"]
mod player;

use avian2d::prelude::*;
use bevy::{ecs::query::QueryFilter, prelude::*};
use headless::{hold, run, start};

/// Position and velocity of the body with a marker.
fn motion<F: QueryFilter>(app: &mut App) -> (Vec2, Vec2) {
    let mut bodies = app.world_mut().query_filtered::<(&Position, &LinearVelocity), F>();
    let (position, velocity) = bodies.single(app.world()).expect("there is one");
    (position.0, velocity.0)
}

/// Puts the body with a marker at a place, at rest.
fn put<F: QueryFilter>(app: &mut App, x: f32, y: f32) {
    let mut bodies = app.world_mut().query_filtered::<(&mut Transform, &mut LinearVelocity), F>();
    let (mut transform, mut velocity) = bodies.single_mut(app.world_mut()).expect("there is one");
    (transform.translation, velocity.0) = (Vec3::new(x, y, 0.0), Vec2::ZERO);
}

#[test]
fn the_door_does_not_crush_what_is_below() {
    use collision_events::{Ball, Door, plugin};
    // When the door is open, falls, and is almost down.
    for wait in [0.0, 0.2, 0.4, 0.5] {
        let mut app = start(plugin);
        put::<With<Ball>>(&mut app, 5.0, 0.4);
        run(&mut app, 2.0);
        assert!(motion::<With<Door>>(&mut app).0.y > 3.4, "the plate opens the door");
        put::<With<Ball>>(&mut app, -9.0, 0.4);
        run(&mut app, wait);
        put::<With<Ball>>(&mut app, 8.0, 0.4);
        for _ in 0..192 {
            run(&mut app, 1.0 / 64.0);
            let (ball, velocity) = motion::<With<Ball>>(&mut app);
            assert!(ball.y > 0.39 && velocity.length() < 1.0, "after {wait} s: {ball} {velocity}");
        }
        put::<With<Ball>>(&mut app, -9.0, 0.4);
        run(&mut app, 3.0);
        assert!((motion::<With<Door>>(&mut app).0.y - 1.0).abs() < 0.01, "the door closes");
    }
}

#[test]
fn the_platform_carries_all_boxes() {
    use moving_platform::{Platform, plugin};
    let mut app = start(plugin);
    run(&mut app, 3.0);
    let offsets = |app: &mut App| -> Vec<Vec2> {
        let (platform, _) = motion::<With<Platform>>(app);
        let mut boxes = app.world_mut().query_filtered::<(&Position, &RigidBody), Without<Platform>>();
        let bodies = boxes.iter(app.world()).filter(|(_, body)| body.is_dynamic());
        bodies.map(|(position, _)| position.0 - platform).collect()
    };
    let before = offsets(&mut app);
    assert_eq!(before.len(), 9);
    run(&mut app, 30.0);
    for (before, after) in before.iter().zip(offsets(&mut app)) {
        assert!(before.distance(after) < 0.05, "{before} {after}");
    }
}

#[test]
fn the_player_walks_jumps_and_rides() {
    use player::{Platform, Player, plugin};
    let mut app = start(plugin);
    run(&mut app, 1.0);
    let (start, velocity) = motion::<With<Player>>(&mut app);
    // Half its length above the floor.
    assert!((start.y - 0.8).abs() < 0.01 && velocity.length() < 0.01, "{start} {velocity}");

    hold(&mut app, KeyCode::KeyD, 1.0);
    let (place, velocity) = motion::<With<Player>>(&mut app);
    assert!((velocity.x - 5.0).abs() < 0.01, "{velocity}");
    // 0.1 s of acceleration cost a quarter of a metre.
    assert!((place.x - start.x - 4.75).abs() < 0.15, "{place}");
    run(&mut app, 1.0);
    assert!(motion::<With<Player>>(&mut app).1.length() < 0.01);

    // A jump of v rises by v² / 2 g, once.
    put::<With<Player>>(&mut app, 3.0, 0.8);
    put::<With<Platform>>(&mut app, -20.0, 2.0);
    run(&mut app, 0.5);
    hold(&mut app, KeyCode::Space, 0.1);
    let mut top = 0.0f32;
    for _ in 0..96 {
        run(&mut app, 1.0 / 64.0);
        top = top.max(motion::<With<Player>>(&mut app).0.y);
    }
    assert!((top - 0.8 - 7.5 * 7.5 / (2.0 * 9.81)).abs() < 0.1, "{top}");
    assert!(motion::<With<Player>>(&mut app).1.length() < 0.01, "it lands");

    // In the middle of the gentle slope.
    put::<With<Player>>(&mut app, -8.2, 2.1);
    run(&mut app, 0.5);
    let before = motion::<With<Player>>(&mut app).0;
    run(&mut app, 2.0);
    let after = motion::<With<Player>>(&mut app).0;
    assert!(before.y > 1.5 && before.distance(after) < 0.01, "{before} {after}");
    hold(&mut app, KeyCode::KeyA, 0.3);
    assert!(motion::<With<Player>>(&mut app).0.y > before.y + 0.3, "it walks up");

    // On the steep slope it slides down.
    put::<With<Player>>(&mut app, 10.0, 3.5);
    run(&mut app, 2.0);
    assert!(motion::<With<Player>>(&mut app).0.y < 1.0);
}

#[test]
fn the_player_rides_the_platform() {
    use player::{Platform, Player, plugin};
    let mut app = start(plugin);
    put::<With<Player>>(&mut app, -4.0, 3.0);
    run(&mut app, 1.0);
    let offset = |app: &mut App| motion::<With<Player>>(app).0 - motion::<With<Platform>>(app).0;
    let before = offset(&mut app);
    run(&mut app, 12.0);
    let after = offset(&mut app);
    assert!(before.distance(after) < 0.1 && after.y > 0.99, "{before} {after}");
}
