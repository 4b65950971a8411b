//! Examples with shapes of their own that move and slide do what they say.

#[path = "../../headless.rs"]
mod headless;
#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/kinematic_character_2d.rs"]
mod kinematic_character;
#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/move_and_slide_2d.rs"]
mod move_and_slide;

use avian2d::prelude::RigidBody;
use bevy::{ecs::query::QueryFilter, input::ButtonState, prelude::*};
use headless::{hold, key, run, start};

/// Where the entity with a marker is.
fn place<F: QueryFilter>(app: &mut App) -> Vec3 {
    let mut moved = app.world_mut().query_filtered::<&Transform, F>();
    moved.single(app.world()).expect("there is one").translation
}

/// Puts the entity with a marker at a place.
fn put<F: QueryFilter>(app: &mut App, x: f32, y: f32) {
    let mut moved = app.world_mut().query_filtered::<&mut Transform, F>();
    moved.single_mut(app.world_mut()).expect("there is one").translation = Vec3::new(x, y, 0.0);
}

/// The names of what the glider touches.
fn touched(app: &mut App) -> Vec<String> {
    let mut gliders = app.world_mut().query::<&move_and_slide::Glider>();
    let glider = gliders.single(app.world()).expect("there is one");
    let name = |entity: &Entity| app.world().get::<Name>(*entity).expect("walls have names").to_string();
    let mut names: Vec<String> = glider.touched.iter().map(name).collect();
    names.sort_unstable();
    names
}

#[test]
fn the_glider_stops_in_a_corner_without_shaking() {
    type Glider = With<move_and_slide::Glider>;
    let mut app = start(move_and_slide::plugin);
    key(&mut app, KeyCode::KeyA, ButtonState::Pressed);
    run(&mut app, 2.0);
    assert_eq!(touched(&mut app), ["left"]);
    key(&mut app, KeyCode::KeyW, ButtonState::Pressed);
    run(&mut app, 3.0);
    assert_eq!(touched(&mut app), ["left", "top"]);
    let corner = place::<Glider>(&mut app);
    assert!(corner.distance(Vec3::new(-8.34, 8.84, 0.0)) < 2.0e-3, "{corner}");
    for _ in 0..64 {
        run(&mut app, 1.0 / 64.0);
        let here = place::<Glider>(&mut app);
        assert!(here.distance(corner) < 1.0e-4, "{here} {corner}");
    }
}

#[test]
fn a_character_of_ones_own_stands_on_slopes_and_jumps() {
    type Walker = With<kinematic_character::Walker>;
    let mut app = start(kinematic_character::plugin);
    let mut bodies = app.world_mut().query_filtered::<&RigidBody, Walker>();
    assert!(bodies.single(app.world()).expect("there is one").is_kinematic());
    put::<Walker>(&mut app, -2.2, 1.5);
    run(&mut app, 1.0);
    let start = place::<Walker>(&mut app);
    assert!((start.y - 0.91).abs() < 2.0e-3, "{start}");
    hold(&mut app, KeyCode::Space, 0.1);
    let mut top = 0.0_f32;
    for _ in 0..64 {
        run(&mut app, 1.0 / 64.0);
        top = top.max(place::<Walker>(&mut app).y);
    }
    let height = 6.0 * 6.0 / (2.0 * 9.81);
    assert!((top - start.y - height).abs() < 0.06, "{top}");

    put::<Walker>(&mut app, 0.0, 0.91);
    run(&mut app, 0.5);
    hold(&mut app, KeyCode::KeyD, 0.75);
    run(&mut app, 0.5);
    let before = place::<Walker>(&mut app);
    run(&mut app, 2.0);
    let after = place::<Walker>(&mut app);
    assert!(before.y > 1.2 && before.distance(after) < 1.0e-3, "on the slope: {before} {after}");

    put::<Walker>(&mut app, -4.0, 3.0);
    run(&mut app, 2.0);
    let below = place::<Walker>(&mut app);
    assert!(below.y < 0.92, "it slides off the steep slope: {below}");
}
