//! Ragdolls that fall on pegs. Look at elbows and knees: they bend one way only. Space lets motors hold all in the pose in which they
//! were spawned, and lets them go limp again.
//!
//! `cargo run --release -p examples2d --example ragdolls`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "\
Elbows and knees bend one way only.
Space: let motors hold all in their pose, or let them go.";

fn main() {
    let scenery = Scenery::with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDebugPlugin, scenery))
        .add_systems(Startup, (spawn_pegs, spawn_ragdolls))
        .add_systems(Update, stiffen)
        .run();
}

fn spawn_ragdolls(mut commands: Commands) {
    // Off until space is pressed.
    let model = MotorModel::SpringDamper { frequency: 4.0, damping_ratio: 1.0 };
    let mut motor = AngularMotor::new(model).with_max_torque(100.0);
    motor.set_enabled(false);
    let human = HumanRagdoll::default().with_drive(motor);
    for i in 0..9 {
        let (row, column) = ((i / 3) as f32, (i % 3) as f32);
        let place = Transform::from_xyz(4.0 * column - 4.0 + 0.5 * row, 8.0 + 2.5 * row, 0.0);
        human.spawn(&mut commands, place.with_rotation(Quat::from_rotation_z(row - 1.0)));
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

fn spawn_pegs(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let (mesh, color) = (meshes.add(Circle::new(0.3)), materials.add(Color::srgb(0.45, 0.45, 0.5)));
    for i in 0..13 {
        let (row, column) = ((i / 7) as f32, (i % 7) as f32);
        commands.spawn((
            RigidBody::Static,
            Collider::circle(0.3),
            Transform::from_xyz(2.5 * column - 7.5 + 1.25 * row, 5.0 - 2.0 * row, 0.0),
            Mesh2d(mesh.clone()),
            MeshMaterial2d(color.clone()),
        ));
    }
}
