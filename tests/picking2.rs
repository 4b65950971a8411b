//! Picking in the plane.

use super::picking::{app, at, camera, entities, frame, perspective, picked, point_at, spawn_camera};
use avian::prelude::*;
use bevy_math::{Mat4, Vec3};
use bevy_transform::components::Transform;

/// A square with sides of 1 m.
pub fn shape() -> Collider {
    Collider::rectangle(1.0, 1.0)
}

/// In perspective, a plane nearer to the camera is met nearer to the middle of the picture.
#[test]
fn the_ray_is_followed_to_the_plane() {
    let mut app = app();
    spawn_camera(&mut app);
    let [near, far] =
        [2.0, 4.0].map(|x| app.world_mut().spawn((RigidBody::Static, shape(), at(x, 0.0, 0.0))).id());
    frame(&mut app);
    point_at(&mut app, 4.0, 0.0);
    let found = picked(&mut app);
    assert_eq!(found[0].0, far);
    let (_, hit) = &found[0];
    assert!(hit.position.unwrap().abs_diff_eq(Vec3::new(4.0, 0.0, 0.0), 1.0e-3), "{hit:?}");
    // The camera is 10 m above, its near plane 0.1 m below it.
    let expected = 116.0_f32.sqrt() * 0.99;
    assert!((hit.depth - expected).abs() < 1.0e-3, "{} for {expected}", hit.depth);
    app.world_mut().resource_mut::<PhysicsPickingSettings>().z_plane = 5.0;
    assert_eq!(entities(&mut app), [near]);
    // Behind the camera, and along the plane.
    for z in [11.0, f32::NAN, f32::INFINITY] {
        app.world_mut().resource_mut::<PhysicsPickingSettings>().z_plane = z;
        assert_eq!(entities(&mut app), []);
    }
}

#[test]
fn what_is_behind_the_camera_is_not_picked() {
    let mut app = app();
    spawn_camera(&mut app);
    let body = app.world_mut().spawn((RigidBody::Static, shape(), Transform::default())).id();
    app.world_mut().spawn((RigidBody::Static, shape(), at(0.0, 0.0, 15.0)));
    frame(&mut app);
    assert_eq!(entities(&mut app), [body]);
}

#[test]
fn a_camera_may_be_turned() {
    let mut app = app();
    // It looks at the origin from the side, at 45 degrees.
    let pose = Transform::from_xyz(10.0, 0.0, 10.0).looking_at(Vec3::ZERO, Vec3::Y);
    app.world_mut().spawn(camera(pose, perspective()));
    let body = app.world_mut().spawn((RigidBody::Static, shape(), Transform::default())).id();
    app.world_mut().spawn((RigidBody::Static, shape(), at(10.0, 0.0, 0.0)));
    frame(&mut app);
    assert_eq!(entities(&mut app), [body]);
}

#[test]
fn a_camera_without_perspective_picks_straight_below() {
    let mut app = app();
    let projection = Mat4::orthographic_rh(-10.0, 10.0, -10.0, 10.0, 1000.0, -1000.0);
    app.world_mut().spawn(camera(Transform::default(), projection));
    let body = app.world_mut().spawn((RigidBody::Static, shape(), at(3.0, -2.0, 0.0))).id();
    frame(&mut app);
    point_at(&mut app, 3.0, -2.0);
    assert_eq!(entities(&mut app), [body]);
}
