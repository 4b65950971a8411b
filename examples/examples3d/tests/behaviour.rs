//! Examples do what they say, by numbers.

#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/car.rs"]
mod car;
#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/explosion.rs"]
mod explosion;
#[path = "../../headless.rs"]
mod headless;
#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/player.rs"]
mod player;
#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/shooting.rs"]
mod shooting;

use avian3d::prelude::*;
use bevy::{ecs::query::QueryFilter, prelude::*};
use headless::{hold, run, start};

/// Position and velocity of the body with a marker.
fn motion<F: QueryFilter>(app: &mut App) -> (Vec3, Vec3) {
    let mut bodies = app.world_mut().query_filtered::<(&Position, &LinearVelocity), F>();
    let (position, velocity) = bodies.single(app.world()).expect("there is one");
    (position.0, velocity.0)
}

/// Puts the body with a marker at a place, at rest.
fn put<F: QueryFilter>(app: &mut App, place: Vec3) {
    let mut bodies = app.world_mut().query_filtered::<(&mut Transform, &mut LinearVelocity), F>();
    let (mut transform, mut velocity) = bodies.single_mut(app.world_mut()).expect("there is one");
    (transform.translation, velocity.0) = (place, Vec3::ZERO);
}

#[test]
fn the_player_walks_jumps_and_rides() {
    use player::{Platform, Player, plugin};
    let mut app = start(plugin);
    run(&mut app, 1.0);
    let (start, velocity) = motion::<With<Player>>(&mut app);
    assert!((start.y - 0.8).abs() < 0.01 && velocity.length() < 0.01, "{start} {velocity}");
    hold(&mut app, KeyCode::KeyS, 1.0);
    let (place, velocity) = motion::<With<Player>>(&mut app);
    assert!((velocity.z - 5.0).abs() < 0.01 && (place.z - start.z - 4.75).abs() < 0.15, "{place} {velocity}");

    run(&mut app, 0.5);
    hold(&mut app, KeyCode::Space, 0.1);
    let mut top = 0.0f32;
    for _ in 0..96 {
        run(&mut app, 1.0 / 64.0);
        top = top.max(motion::<With<Player>>(&mut app).0.y);
    }
    assert!((top - 0.8 - 6.0 * 6.0 / (2.0 * 9.81)).abs() < 0.1, "{top}");

    // In the middle of the gentle ramp.
    put::<With<Player>>(&mut app, Vec3::new(-8.3, 1.6, 0.0));
    run(&mut app, 0.5);
    let before = motion::<With<Player>>(&mut app).0;
    run(&mut app, 2.0);
    let after = motion::<With<Player>>(&mut app).0;
    assert!(before.y > 1.3 && before.distance(after) < 0.01, "{before} {after}");
    // On the steep one it slides down.
    put::<With<Player>>(&mut app, Vec3::new(8.0, 3.5, 0.0));
    run(&mut app, 2.0);
    assert!(motion::<With<Player>>(&mut app).0.y < 1.0);

    let platform = motion::<With<Platform>>(&mut app).0;
    put::<With<Player>>(&mut app, platform + Vec3::Y);
    run(&mut app, 1.0);
    let offset = |app: &mut App| motion::<With<Player>>(app).0 - motion::<With<Platform>>(app).0;
    let before = offset(&mut app);
    run(&mut app, 12.0);
    let after = offset(&mut app);
    assert!(before.distance(after) < 0.1 && after.y > 0.9, "{before} {after}");
}

#[test]
fn an_explosion_pushes_near_bricks_harder() {
    use explosion::{Brick, plugin};
    let mut app = start(plugin);
    run(&mut app, 1.0);
    hold(&mut app, KeyCode::Space, 1.0 / 64.0);
    let mut bricks = app.world_mut().query_filtered::<(&Position, &LinearVelocity), With<Brick>>();
    let center = Vec3::new(0.0, 0.5, 0.0);
    let mut speeds: Vec<(f32, f32)> =
        bricks.iter(app.world()).map(|(at, v)| (at.0.distance(center), v.0.length())).collect();
    speeds.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mean = |part: &[(f32, f32)]| part.iter().map(|(_, speed)| speed).sum::<f32>() / part.len() as f32;
    let (near, far) = (&speeds[..20], &speeds[speeds.len() - 20..]);
    assert!(mean(near) > 1.5 * mean(far) && mean(far) > 0.1, "{} {}", mean(near), mean(far));
    run(&mut app, 4.0);
    assert!(bricks.iter(app.world()).all(|(at, _)| at.is_finite() && at.y < 30.0));
    hold(&mut app, KeyCode::Enter, 1.0 / 64.0);
    run(&mut app, 2.0);
    let highest = bricks.iter(app.world()).map(|(at, _)| at.y).fold(0.0, f32::max);
    assert!((highest - 2.7).abs() < 0.05, "a new hut of five layers of 0.6 m stands: {highest}");
}

#[test]
fn a_shot_flashes_where_it_strikes() {
    use shooting::{Life, plugin, shoot_along};
    let mut app = start(plugin);
    run(&mut app, 1.0);
    let ray = Ray3d::new(Vec3::new(0.0, 3.0, 13.0), Dir3::NEG_Z);
    app.world_mut().run_system_cached_with(shoot_along, ray).expect("it runs");
    let mut flashes = app.world_mut().query_filtered::<&Transform, (With<Life>, Without<Collider>)>();
    let mut seen = Vec::new();
    for _ in 0..64 {
        run(&mut app, 1.0 / 64.0);
        seen.extend(flashes.iter(app.world()).map(|flash| flash.translation));
    }
    // The first at the face of the wall.
    assert!(seen.first().is_some_and(|at| (at.z - 0.25).abs() < 0.1 && at.x.abs() < 0.1), "{seen:?}");
    run(&mut app, 10.0);
    assert_eq!(app.world_mut().query::<&Life>().iter(app.world()).count(), 0, "all are taken away");
}

#[test]
fn the_car_stands_drives_steers_and_brakes() {
    use car::{Car, plugin};
    let mut app = start(plugin);
    run(&mut app, 3.0);
    let (start, velocity) = motion::<With<Car>>(&mut app);
    // Springs of 20 kN/m bear 864 kg: they give way by m g / 4 k.
    let sag = 864.0 * 9.81 / 80_000.0;
    assert!((start.y - (0.9 - sag)).abs() < 0.02 && velocity.length() < 0.01, "{start} {velocity}");
    hold(&mut app, KeyCode::KeyW, 1.5);
    let (place, velocity) = motion::<With<Car>>(&mut app);
    assert!(velocity.z < -5.0 && velocity.x.abs() < 0.1 && place.z < start.z - 3.0, "{place} {velocity}");
    hold(&mut app, KeyCode::KeyA, 0.7);
    let (_, velocity) = motion::<With<Car>>(&mut app);
    assert!(velocity.x < -1.0, "it turns to the left: {velocity}");
    hold(&mut app, KeyCode::Space, 2.0);
    let (_, velocity) = motion::<With<Car>>(&mut app);
    assert!(velocity.length() < 0.2, "it stops: {velocity}");
    let mut cars = app.world_mut().query_filtered::<&Rotation, With<Car>>();
    let up = *cars.single(app.world()).expect("one car") * Vec3::Y;
    assert!(up.y > 0.8, "{up}");
}
