//! A pile of boxes and discs falls on a floor. Look at how little it takes: a body, a collider, a place to start from. The
//! pile comes to rest and sleeps.
//!
//! `cargo run --release -p examples2d --example hello`

use avian2d::prelude::*;
use bevy::prelude::*;

fn main() {
    App::new().add_plugins((DefaultPlugins, PhysicsPlugins::default())).add_systems(Startup, setup).run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    // Sizes are in metres; the camera shows 50 pixels for each.
    commands.spawn((
        Camera2d,
        Projection::Orthographic(OrthographicProjection {
            scale: 1.0 / 50.0,
            ..OrthographicProjection::default_2d()
        }),
        Transform::from_xyz(0.0, 5.0, 0.0),
    ));

    commands.spawn(Text::new("The pile falls, comes to rest, and sleeps."));

    // The floor: static, so nothing moves it. Its top is at y = 0.
    commands.spawn((
        RigidBody::Static,
        Collider::rectangle(24.0, 1.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
        Mesh2d(meshes.add(Rectangle::new(24.0, 1.0))),
        MeshMaterial2d(materials.add(Color::srgb(0.35, 0.4, 0.45))),
    ));

    // The pile: 12 × 12 bodies in a loose grid, every other one a disc.
    let square = meshes.add(Rectangle::new(0.6, 0.6));
    let disc = meshes.add(Circle::new(0.3));
    let amber = materials.add(Color::srgb(0.9, 0.6, 0.2));
    let teal = materials.add(Color::srgb(0.2, 0.65, 0.6));
    for i in 0..144 {
        let (x, y) = (i % 12, i / 12);
        let sway = 0.1 * (y % 3) as f32;
        let place = Vec3::new(0.7 * x as f32 - 3.85 + sway, 0.7 * y as f32 + 1.0, 0.0);
        let mut body = commands.spawn((RigidBody::Dynamic, Transform::from_translation(place)));
        if (x + y) % 2 == 0 {
            body.insert((
                Collider::rectangle(0.6, 0.6),
                Mesh2d(square.clone()),
                MeshMaterial2d(amber.clone()),
            ));
        } else {
            body.insert((Collider::circle(0.3), Mesh2d(disc.clone()), MeshMaterial2d(teal.clone())));
        }
    }
}
