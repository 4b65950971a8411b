//! Five boxes on a slope with friction from 0 to 0.8, and five balls with restitution from 0 to 1. Look at which boxes slide:
//! the slope is 25° steep, so friction above tan 25° = 0.47 holds. The last ball comes back to where it fell from.
//!
//! `cargo run --release -p examples3d --example materials`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
Friction from 0 to 0.8: on 25 degrees the boxes with more than 0.47 stay. Restitution from 0 to 1.";

fn main() {
    let scenery = Scenery::new(Vec3::new(0.0, 6.0, 16.0), Vec3::new(0.0, 2.0, 0.0)).with_hint(HINT);
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
    let grey = materials.add(Color::srgb(0.35, 0.4, 0.45));
    let amber = materials.add(Color::srgb(0.9, 0.6, 0.2));
    let teal = materials.add(Color::srgb(0.2, 0.65, 0.6));
    let size = Vec3::new(12.0, 1.0, 6.0);
    let slope = Quat::from_rotation_x(25f32.to_radians());
    for (place, rotation) in [(Vec3::new(0.0, 1.0, -4.0), slope), (Vec3::new(0.0, -0.5, 4.0), Quat::IDENTITY)]
    {
        commands.spawn((
            RigidBody::Static,
            Collider::cuboid(size.x, size.y, size.z),
            // The rule of the pair is the one of higher priority: Multiply is above Average, the default.
            Friction::new(1.0).with_combine_rule(CoefficientCombine::Multiply),
            Restitution::new(1.0).with_combine_rule(CoefficientCombine::Multiply),
            Transform::from_translation(place).with_rotation(rotation),
            Mesh3d(meshes.add(Cuboid::from_size(size))),
            MeshMaterial3d(grey.clone()),
        ));
    }
    let cube = meshes.add(Cuboid::from_length(0.8));
    let ball = meshes.add(Sphere::new(0.4));
    for i in 0..5 {
        let x = 2.0 * i as f32 - 4.0;
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(0.8, 0.8, 0.8),
            Friction::new(0.2 * i as f32),
            Transform::from_translation(Vec3::new(x, 1.0, -4.0) + slope * Vec3::new(0.0, 0.95, -2.0))
                .with_rotation(slope),
            Mesh3d(cube.clone()),
            MeshMaterial3d(amber.clone()),
        ));
        commands.spawn((
            RigidBody::Dynamic,
            Collider::sphere(0.4),
            Restitution::new(0.25 * i as f32),
            Transform::from_xyz(x, 4.0, 4.0),
            Mesh3d(ball.clone()),
            MeshMaterial3d(teal.clone()),
        ));
    }
}
