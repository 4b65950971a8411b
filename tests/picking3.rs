//! Picking in space.

use super::picking::{app, at, entities, frame, picked, spawn_camera};
use avian::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::Transform;

/// A cube with sides of 1 m.
pub fn shape() -> Collider {
    Collider::cuboid(1.0, 1.0, 1.0)
}

#[test]
fn a_hit_has_a_point_a_normal_and_a_depth() {
    let mut app = app();
    spawn_camera(&mut app);
    app.world_mut().spawn((RigidBody::Static, shape(), Transform::default()));
    frame(&mut app);
    let found = picked(&mut app);
    let (_, hit) = &found[0];
    assert!(hit.position.unwrap().abs_diff_eq(Vec3::Z * 0.5, 1.0e-4), "{hit:?}");
    assert!(hit.normal.unwrap().abs_diff_eq(Vec3::Z, 1.0e-5), "{hit:?}");
    // From the near plane, 0.1 m below the camera.
    assert!((hit.depth - 9.4).abs() < 1.0e-4, "{hit:?}");
}

#[test]
fn a_camera_in_a_sensor_picks_what_is_in_it_too() {
    let mut app = app();
    spawn_camera(&mut app);
    let room = Collider::cuboid(100.0, 100.0, 100.0);
    app.world_mut().spawn((RigidBody::Static, room, Sensor, Transform::default()));
    let body = app.world_mut().spawn((RigidBody::Static, shape(), at(0.0, 0.0, 1.0))).id();
    frame(&mut app);
    assert_eq!(entities(&mut app), [body]);
}
