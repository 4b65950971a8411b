//! Ragdolls that fall down a flight of stairs. Look at elbows and knees: they bend one way only, as far as a human's. Space lets those
//! in the air stiffen to the pose in which they were spawned, and go limp again.
//!
//! `cargo run --release -p examples3d --example ragdolls`

use avian3d::prelude::*;
use bevy::{asset::RenderAssetUsages, mesh::Indices, mesh::PrimitiveTopology, prelude::*};
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
Elbows and knees bend as far as a human's.
Space: let motors hold all in their pose, or let them go.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(9.0, 6.0, 12.0), Vec3::new(0.0, 2.0, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_systems(Startup, (spawn_stairs, spawn_ragdolls))
        .add_systems(Update, (show_bones, stiffen))
        .run();
}

fn spawn_ragdolls(mut commands: Commands) {
    // Off until space is pressed.
    let model = MotorModel::SpringDamper { frequency: 4.0, damping_ratio: 1.0 };
    let mut motor = AngularMotor::new(model).with_max_torque(100.0);
    motor.set_enabled(false);
    let human = HumanRagdoll::default().with_drive(motor);
    for i in 0..12 {
        let (row, column) = ((i / 4) as f32, (i % 4) as f32);
        let place = Vec3::new(-3.0 + 1.5 * row, 6.0 + 2.0 * row, 1.2 * column - 1.8);
        let turn = Quat::from_rotation_y(column) * Quat::from_rotation_x(0.4 * row);
        human.spawn(&mut commands, Transform::from_translation(place).with_rotation(turn));
    }
}

fn stiffen(
    keys: Res<ButtonInput<KeyCode>>,
    ragdolls: Query<&Ragdoll>,
    mut joints: RagdollJoints,
    mut is_stiff: Local<bool>,
) {
    if keys.just_pressed(KeyCode::Space) {
        *is_stiff = !*is_stiff;
        for ragdoll in &ragdolls {
            joints.set_enabled(ragdoll, *is_stiff);
        }
    }
}

/// Gives each bone the mesh of its collider.
fn show_bones(
    bones: Query<(Entity, &Collider), (With<RigidBody>, Without<Mesh3d>)>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for (bone, collider) in &bones {
        let Ok(surface) = collider.trimesh_builder().build() else { continue };
        let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, surface.vertices.clone())
            .with_inserted_indices(Indices::U32(surface.indices.as_flattened().to_vec()))
            .with_computed_normals();
        let color = materials.add(Color::hsl(f32::from(bone.index_u32() as u8) * 1.4, 0.4, 0.6));
        commands.entity(bone).insert((Mesh3d(meshes.add(mesh)), MeshMaterial3d(color)));
    }
}

fn spawn_stairs(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let color = materials.add(Color::srgb(0.45, 0.45, 0.5));
    for step in 0..10 {
        let height = 4.0 - 0.4 * step as f32;
        let size = Vec3::new(0.6, height, 6.0);
        commands.spawn((
            RigidBody::Static,
            Collider::cuboid(size.x, size.y, size.z),
            Transform::from_xyz(0.6 * step as f32 - 4.0, 0.5 * height, 0.0),
            Mesh3d(meshes.add(Cuboid::from_size(size))),
            MeshMaterial3d(color.clone()),
        ));
    }
}
