//! A platform carries boxes to and fro. Look at the boxes: friction takes them along, because the platform is kinematic and moves
//! by its velocity instead of being teleported.
//!
//! `cargo run --release -p examples2d --example moving_platform`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::with_floor()))
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, turn_round)
        .run();
}

#[derive(Component)]
struct Platform;

fn turn_round(mut platforms: Query<(&Transform, &mut LinearVelocity), With<Platform>>) {
    for (transform, mut velocity) in &mut platforms {
        if transform.translation.x.abs() > 5.0 && transform.translation.x * velocity.x > 0.0 {
            velocity.x = -velocity.x;
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    commands.spawn((
        Platform,
        RigidBody::Kinematic,
        Collider::rectangle(4.0, 0.4),
        LinearVelocity(Vec2::new(2.0, 0.0)),
        Transform::from_xyz(0.0, 3.0, 0.0),
        Mesh2d(meshes.add(Rectangle::new(4.0, 0.4))),
        MeshMaterial2d(materials.add(Color::srgb(0.5, 0.55, 0.6))),
    ));
    let square = meshes.add(Rectangle::new(0.5, 0.5));
    let amber = materials.add(Color::srgb(0.9, 0.6, 0.2));
    for i in 0..9 {
        commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(0.5, 0.5),
            Transform::from_xyz((i % 3) as f32 - 1.0, 4.0 + 0.6 * (i / 3) as f32, 0.0),
            Mesh2d(square.clone()),
            MeshMaterial2d(amber.clone()),
        ));
    }
}
