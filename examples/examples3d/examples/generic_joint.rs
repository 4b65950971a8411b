//! Tables on generic joints, whose axes are set one by one. From the left: sprung along all axes; sliding on a plane between limits;
//! tilting about two axes, sprung; driven up and down while it may spin. Space pushes them.
//!
//! `cargo run --release -p examples3d --example generic_joint`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
Each axis is free, locked, limited, sprung or driven. From the left: sprung along all; a plane with limits;
tilting; driven up and down while it may spin.
Space: push all.";

fn main() {
    let scenery = Scenery::new(Vec3::new(0.0, 6.0, 13.0), Vec3::new(0.0, 2.0, 0.0)).with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDebugPlugin, scenery))
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, drive)
        .add_systems(Update, push)
        .run();
}

/// The settings of each joint.
fn joints(post: Entity, table: Entity) -> [GenericJoint; 4] {
    use JointCoordinate::{SwingY, SwingZ, Twist, X, Y, Z};
    let new = || GenericJoint::new(post, table);
    let spring =
        JointAxis::FREE.with_spring(0.0, MotorModel::SpringDamper { frequency: 1.5, damping_ratio: 0.2 });
    // Held by a motor of its own, up and down.
    let lift = LinearMotor::new(MotorModel::SpringDamper { frequency: 2.0, damping_ratio: 1.0 });
    [
        JointCoordinate::TRANSLATIONS
            .into_iter()
            .fold(new().with_locked([Twist, SwingY, SwingZ]), |joint, axis| joint.with_axis(axis, spring)),
        new()
            .with_locked([Y, Twist, SwingY, SwingZ])
            .with_axis(X, JointAxis::limited(-0.8, 0.8))
            .with_axis(Z, JointAxis::limited(-0.8, 0.8)),
        new().with_locked([X, Y, Z, SwingY]).with_axis(Twist, spring).with_axis(SwingZ, spring),
        new().with_locked([X, Z, Twist, SwingZ]).with_motor(Y, lift),
    ]
}

#[derive(Component)]
struct Lift;

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let size = Vec3::new(2.0, 0.2, 2.0);
    let (mesh, color) = (meshes.add(Cuboid::from_size(size)), materials.add(Color::srgb(0.3, 0.5, 0.7)));
    for i in 0..4 {
        let at = Transform::from_xyz(4.0 * i as f32 - 6.0, 2.0, 0.0);
        let post = commands.spawn((RigidBody::Static, at)).id();
        let table = commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(size.x, size.y, size.z),
            at,
            Mesh3d(mesh.clone()),
            MeshMaterial3d(color.clone()),
        ));
        let table = table.id();
        let joint = commands.spawn(joints(post, table)[i].clone()).id();
        if i == 3 {
            commands.entity(joint).insert(Lift);
        }
    }
}

fn drive(time: Res<Time>, mut lifts: Query<&mut GenericJoint, With<Lift>>) {
    for mut lift in &mut lifts {
        lift.axis_mut(JointCoordinate::Y).motor.target_position = time.elapsed_secs().sin();
    }
}

fn push(keys: Res<ButtonInput<KeyCode>>, mut tables: Query<Forces, With<Collider>>) {
    if keys.just_pressed(KeyCode::Space) {
        for mut table in &mut tables {
            let corner = table.position().0 + Vec3::new(0.9, 0.0, 0.5);
            table.apply_linear_impulse_at_point(Vec3::new(0.8, -1.5, 0.6), corner);
        }
    }
}
