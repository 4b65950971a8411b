//! The first example of the package's README, as it stands there. Look at the pile: it falls, comes to rest, and its lines
//! darken when it sleeps.

use avian2d::prelude::*;
use bevy::prelude::*;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default().with_length_unit(50.0), PhysicsDebugPlugin))
        .insert_resource(Gravity(Vec2::NEG_Y * 500.0))
        .add_systems(Startup, setup)
        .run();
}

fn setup(mut commands: Commands) {
    commands.spawn(Camera2d);
    // A floor that nothing moves, seen by the lines of the debug plugin. A metre is 50 pixels ...
    commands.spawn((
        RigidBody::Static,
        Collider::rectangle(1000.0, 20.0),
        Transform::from_xyz(0.0, -250.0, 0.0),
    ));
    // ... and a pile that falls on it.
    for i in 0..60u8 {
        let (x, y) = (f32::from(i % 6), f32::from(i / 6));
        let collider = if i % 2 == 0 { Collider::rectangle(40.0, 40.0) } else { Collider::circle(20.0) };
        commands.spawn((
            RigidBody::Dynamic,
            collider,
            Transform::from_xyz(50.0 * x - 120.0 + y, 50.0 * y - 200.0, 0.0),
        ));
    }
}
