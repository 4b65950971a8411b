//! The first example of the README, as it stands there. Look at the pile: it falls, comes to rest, and its lines darken
//! when it sleeps.

use avian3d::prelude::*;
use bevy::prelude::*;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDebugPlugin))
        .add_systems(Startup, setup)
        .run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let looking = |x, y, z| Transform::from_xyz(x, y, z).looking_at(Vec3::Y * 1.5, Vec3::Y);
    commands.spawn((Camera3d::default(), looking(-7.0, 6.0, 11.0)));
    commands.spawn((DirectionalLight::default(), looking(-3.0, 8.0, 5.0)));
    // A floor that nothing moves, seen by the lines of the debug plugin ...
    commands.spawn((RigidBody::Static, Collider::cuboid(12.0, 0.1, 12.0)));
    // ... and a pile that falls on it.
    let (mesh, amber) = (meshes.add(Cuboid::from_length(0.8)), materials.add(Color::srgb(0.9, 0.6, 0.2)));
    for i in 0..125u8 {
        let [x, y, z] = [i % 5, i / 25, i / 5 % 5].map(f32::from);
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(0.8, 0.8, 0.8),
            Transform::from_xyz(x - 2.0, y + 1.0, z - 2.0).with_rotation(Quat::from_rotation_y(y)),
            (Mesh3d(mesh.clone()), MeshMaterial3d(amber.clone())),
        ));
    }
}
