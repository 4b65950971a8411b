//! A pile of boxes and balls falls on a floor. Look at how little it takes: a body, a collider, a place to start from. The
//! pile comes to rest and sleeps.
//!
//! `cargo run --release -p examples3d --example hello`

use avian3d::prelude::*;
use bevy::prelude::*;

fn main() {
    App::new().add_plugins((DefaultPlugins, PhysicsPlugins::default())).add_systems(Startup, setup).run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.spawn((
        Camera3d::default(),
        Transform::from_xyz(-9.0, 7.0, 14.0).looking_at(Vec3::new(0.0, 2.0, 0.0), Vec3::Y),
    ));
    commands.spawn((
        DirectionalLight { shadow_maps_enabled: true, ..default() },
        Transform::from_xyz(-3.0, 8.0, 5.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));

    commands.spawn(Text::new("The pile falls, comes to rest, and sleeps."));

    // The floor: static, so nothing moves it. Its top is at y = 0.
    commands.spawn((
        RigidBody::Static,
        Collider::cuboid(30.0, 1.0, 30.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
        Mesh3d(meshes.add(Cuboid::new(30.0, 1.0, 30.0))),
        MeshMaterial3d(materials.add(Color::srgb(0.35, 0.4, 0.45))),
    ));

    // The pile: 6 × 6 × 6 bodies in a loose grid, every other one a ball.
    let cube = meshes.add(Cuboid::new(0.8, 0.8, 0.8));
    let ball = meshes.add(Sphere::new(0.4));
    let amber = materials.add(Color::srgb(0.9, 0.6, 0.2));
    let teal = materials.add(Color::srgb(0.2, 0.65, 0.6));
    for i in 0..216 {
        let (x, y, z) = (i % 6, i / 36, i / 6 % 6);
        let sway = 0.1 * (y % 3) as f32;
        let place = Vec3::new(x as f32 - 2.5 + sway, y as f32 + 1.5, z as f32 - 2.5 - sway);
        let mut body = commands.spawn((RigidBody::Dynamic, Transform::from_translation(place)));
        if (x + y + z) % 2 == 0 {
            body.insert((
                Collider::cuboid(0.8, 0.8, 0.8),
                Mesh3d(cube.clone()),
                MeshMaterial3d(amber.clone()),
            ));
        } else {
            body.insert((Collider::sphere(0.4), Mesh3d(ball.clone()), MeshMaterial3d(teal.clone())));
        }
    }
}
