//! The first example of the README, as it stands there.

use avian3d::prelude::*;
use bevy::prelude::*;

fn main() {
    App::new().add_plugins((DefaultPlugins, PhysicsPlugins::default())).add_systems(Startup, setup).run();
}

fn setup(mut commands: Commands) {
    // A floor that nothing moves ...
    commands.spawn((
        RigidBody::Static,
        Collider::cuboid(20.0, 1.0, 20.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
    ));
    // ... and a pile that falls on it.
    for i in 0..100 {
        let (x, y, z) = (i % 5, i / 25, i / 5 % 5);
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(0.8, 0.8, 0.8),
            Transform::from_xyz(x as f32 - 2.0, y as f32 + 1.0, z as f32 - 2.0),
        ));
    }
}
