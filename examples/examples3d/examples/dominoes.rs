//! A ball starts a spiral of dominoes. Look at the wave: it runs on at a constant speed, and bodies behind it fall asleep.
//!
//! `cargo run --release -p examples3d --example dominoes`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "The wave runs on at a constant speed. Bodies behind it fall asleep.";

fn main() {
    let scenery = Scenery::new(Vec3::new(0.0, 12.0, 14.0), Vec3::ZERO).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let domino = meshes.add(Cuboid::new(0.1, 1.0, 0.5));
    let colors = [0.0, 120.0, 240.0].map(|hue| materials.add(Color::hsl(hue, 0.5, 0.6)));
    let (mut angle, mut radius) = (0.0f32, 2.0f32);
    for i in 0..160 {
        let place = Vec3::new(radius * angle.cos(), 0.5, -radius * angle.sin());
        // The thin side points along the spiral.
        let rotation = Quat::from_rotation_y(angle + core::f32::consts::FRAC_PI_2);
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(0.1, 1.0, 0.5),
            Transform::from_translation(place).with_rotation(rotation),
            Mesh3d(domino.clone()),
            MeshMaterial3d(colors[i % 3].clone()),
        ));
        angle += 0.45 / radius;
        radius += 0.45 * 0.8 / (core::f32::consts::TAU * radius);
    }
    commands.spawn((
        RigidBody::Dynamic,
        Collider::sphere(0.25),
        LinearVelocity(Vec3::new(0.0, 0.0, -3.0)),
        Transform::from_xyz(2.0, 0.8, 0.6),
        Mesh3d(meshes.add(Sphere::new(0.25))),
        MeshMaterial3d(colors[0].clone()),
    ));
}
