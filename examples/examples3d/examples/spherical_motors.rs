//! Arms on ball joints whose motors turn them to a rotation. Look at the colors: green arms take the shortest arc (SLERP), orange ones
//! twist and swing by motors of their own, and the last of each is weaker than its weight. All get the same target.
//!
//! `cargo run --release -p examples3d --example spherical_motors`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
Motors turn all arms to the same rotation, which changes every two seconds.
Green: the shortest arc. Orange: twist and swing on their own. The right one of each is too weak.";

fn main() {
    let scenery = Scenery::new(Vec3::new(0.0, 5.0, 13.0), Vec3::new(0.0, 3.0, 0.0)).with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDebugPlugin, scenery))
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, set_targets)
        .run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let size = Vec3::new(0.3, 2.0, 0.8);
    let mesh = meshes.add(Cuboid::from_size(size));
    let green = materials.add(Color::srgb(0.3, 0.6, 0.35));
    let orange = materials.add(Color::srgb(0.85, 0.5, 0.2));
    let model = MotorModel::SpringDamper { frequency: 2.0, damping_ratio: 1.0 };
    for (i, max_torque) in [f32::MAX, 2.0, f32::MAX, 2.0].into_iter().enumerate() {
        let at = Vec3::new(3.0 * i as f32 - 4.5, 3.0, 0.0);
        let post = commands.spawn((RigidBody::Static, Transform::from_translation(at))).id();
        let arm = commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(size.x, size.y, size.z),
            Transform::from_translation(at + Vec3::Y),
            Mesh3d(mesh.clone()),
            MeshMaterial3d(if i < 2 { green.clone() } else { orange.clone() }),
        ));
        let drive = AngularDrive::new(model).with_max_torque(max_torque);
        let motor = SphericalMotor::new(model).with_max_torque(max_torque);
        let motor = if i < 2 { motor } else { motor.with_twist_and_swing(drive, drive) };
        let joint = SphericalJoint::new(post, arm.id()).with_local_anchor2(Vec3::NEG_Y).with_motor(motor);
        commands.spawn(joint);
    }
}

fn set_targets(time: Res<Time>, mut joints: Query<&mut SphericalJoint>) {
    let targets = [
        Quat::IDENTITY,
        Quat::from_rotation_z(1.2),
        Quat::from_rotation_x(-1.0) * Quat::from_rotation_y(1.5),
        Quat::from_rotation_y(2.5),
    ];
    let target = targets[(0.5 * time.elapsed_secs()) as usize % targets.len()];
    for mut joint in &mut joints {
        joint.motor.target_rotation = target;
    }
}
