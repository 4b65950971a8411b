//! Hammers of two colliders each. Look at how they tumble: the heavy head pulls the centre of mass to its side, because mass comes
//! from the shapes and densities of all colliders of a body.
//!
//! `cargo run --release -p examples3d --example child_colliders`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
The hammers tumble about their heads: mass comes from the shapes and densities of both colliders.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(-6.0, 5.0, 12.0), Vec3::new(0.0, 2.0, 0.0)).with_floor().with_hint(HINT);
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
    let (handle, head) = (meshes.add(Cuboid::new(2.0, 0.2, 0.2)), meshes.add(Cuboid::new(0.4, 0.5, 0.8)));
    let (wood, iron) =
        (materials.add(Color::srgb(0.7, 0.5, 0.3)), materials.add(Color::srgb(0.4, 0.4, 0.45)));
    for i in 0..12 {
        let place = Vec3::new((i % 4) as f32 * 2.5 - 3.75, 3.0 + 1.5 * (i / 4) as f32, 0.0);
        commands
            .spawn((
                RigidBody::Dynamic,
                Transform::from_translation(place).with_rotation(Quat::from_rotation_y(i as f32)),
                Visibility::default(),
            ))
            .with_children(|hammer| {
                hammer.spawn((
                    Collider::cuboid(2.0, 0.2, 0.2),
                    ColliderDensity(0.6),
                    Mesh3d(handle.clone()),
                    MeshMaterial3d(wood.clone()),
                ));
                hammer.spawn((
                    Collider::cuboid(0.4, 0.5, 0.8),
                    ColliderDensity(7.8),
                    Transform::from_xyz(1.1, 0.0, 0.0),
                    Mesh3d(head.clone()),
                    MeshMaterial3d(iron.clone()),
                ));
            });
    }
}
