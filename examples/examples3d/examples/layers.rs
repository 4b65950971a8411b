//! Red and blue balls fall on two floors. Look at the upper floor: it stops red balls only, because layers say who collides with
//! whom. Balls of different colours pass through each other, too.
//!
//! `cargo run --release -p examples3d --example layers`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "The upper floor stops red balls only. Balls of different colors pass through each other.";

fn main() {
    let scenery = Scenery::new(Vec3::new(0.0, 6.0, 14.0), Vec3::new(0.0, 2.5, 0.0)).with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .run();
}

#[derive(PhysicsLayer, Default, Clone, Copy)]
enum Layer {
    #[default]
    Floor,
    Red,
    Blue,
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let floors = [
        (0.0, CollisionLayers::new(Layer::Floor, LayerMask::ALL), Color::srgb(0.35, 0.4, 0.45)),
        (3.0, CollisionLayers::new(Layer::Floor, Layer::Red), Color::srgb(0.6, 0.35, 0.35)),
    ];
    for (y, layers, color) in floors {
        commands.spawn((
            RigidBody::Static,
            Collider::cuboid(8.0, 0.2, 8.0),
            layers,
            Transform::from_xyz(0.0, y, 0.0),
            Mesh3d(meshes.add(Cuboid::new(8.0, 0.2, 8.0))),
            MeshMaterial3d(materials.add(color)),
        ));
    }
    let ball = meshes.add(Sphere::new(0.3));
    let red = materials.add(Color::srgb(0.9, 0.3, 0.25));
    let blue = materials.add(Color::srgb(0.25, 0.45, 0.9));
    for i in 0..100 {
        let (layer, color) = if i % 2 == 0 { (Layer::Red, &red) } else { (Layer::Blue, &blue) };
        let place =
            Vec3::new((i % 10) as f32 * 0.7 - 3.15, 6.0 + (i % 3) as f32, (i / 10) as f32 * 0.7 - 3.15);
        commands.spawn((
            RigidBody::Dynamic,
            Collider::sphere(0.3),
            // Membership, then what it collides with: the floors and its own colour.
            CollisionLayers::new(layer, [Layer::Floor, layer]),
            Transform::from_translation(place),
            Mesh3d(ball.clone()),
            MeshMaterial3d(color.clone()),
        ));
    }
}
