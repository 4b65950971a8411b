//! A car on two wheel joints. Look at the wheels: they are bodies on springs, spun by motors of their joints, and climb by friction. Left
//! and right or A and D drive.
//!
//! `cargo run --release -p examples2d --example wheels`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "\
Wheels are bodies on springs. Motors of their joints spin them.
Left, Right or A, D: drive.";

/// Radius of a wheel in metres, its greatest spin in rad/s and torque in N·m.
const WHEEL: (f32, f32, f32) = (0.5, 20.0, 40.0);

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::with_floor().with_hint(HINT)))
        .add_systems(Startup, (spawn_car, spawn_hills))
        .add_systems(FixedUpdate, drive)
        .run();
}

fn spawn_car(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let chassis = commands.spawn((
        RigidBody::Dynamic,
        Collider::rectangle(3.0, 0.6),
        Transform::from_xyz(-8.0, 1.5, 0.0),
        Mesh2d(meshes.add(Rectangle::new(3.0, 0.6))),
        MeshMaterial2d(materials.add(Color::srgb(0.7, 0.25, 0.2))),
    ));
    let chassis = chassis.id();
    let mesh = meshes.add(Circle::new(WHEEL.0));
    let color = materials.add(Color::srgb(0.2, 0.2, 0.22));
    // In N/m and N·s/m: two of them sag by 9 cm under the chassis.
    let spring = MotorModel::ForceBased { stiffness: 100.0, damping: 10.0 };
    let engine = MotorModel::AccelerationBased { stiffness: 0.0, damping: 10.0 };
    for x in [-1.0, 1.0] {
        let at = Vec2::new(x, -0.6);
        let wheel = commands.spawn((
            RigidBody::Dynamic,
            Collider::circle(WHEEL.0),
            Friction::new(1.2),
            Transform::from_xyz(-8.0 + at.x, 1.5 + at.y, 0.0),
            Mesh2d(mesh.clone()),
            MeshMaterial2d(color.clone()),
        ));
        let joint = WheelJoint::new(chassis, wheel.id())
            .with_local_anchor1(at)
            .with_suspension(LinearMotor::new(spring))
            .with_suspension_limits(-0.3, 0.3)
            .with_motor(AngularMotor::new(engine).with_max_torque(WHEEL.2));
        commands.spawn((joint, JointCollisionDisabled));
    }
}

fn drive(keys: Res<ButtonInput<KeyCode>>, mut wheels: Query<&mut WheelJoint>) {
    let is_down = |codes: [KeyCode; 2]| f32::from(u8::from(keys.any_pressed(codes)));
    let left = is_down([KeyCode::KeyA, KeyCode::ArrowLeft]) - is_down([KeyCode::KeyD, KeyCode::ArrowRight]);
    for mut wheel in &mut wheels {
        wheel.motor.target_velocity = WHEEL.1 * left;
    }
}

fn spawn_hills(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let (mesh, color) = (meshes.add(Circle::new(1.0)), materials.add(Color::srgb(0.35, 0.4, 0.45)));
    for (x, sunk) in [(-4.0, 0.8), (-1.5, 0.7), (1.5, 0.6), (5.0, 0.5), (8.5, 0.4)] {
        commands.spawn((
            RigidBody::Static,
            Collider::circle(1.0),
            Transform::from_xyz(x, -sunk, 0.0),
            Mesh2d(mesh.clone()),
            MeshMaterial2d(color.clone()),
        ));
    }
}
