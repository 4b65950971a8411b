//! A car on four wheel joints. Look at the wheels: they are bodies on springs, spun and steered by motors of their joints, and roll by
//! friction. W and S or up and down drive, A and D or left and right steer. `car` does without wheels: it has rays.
//!
//! `cargo run --release -p examples3d --example wheels`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::{Readout, Scenery};

/// On the screen.
const HINT: &str = "\
Wheels are bodies on springs. Motors of their joints spin and steer them.
Up, Down or W, S: drive. Left, Right or A, D: steer.";

/// Radius and width of a wheel, in metres.
const WHEEL: (f32, f32) = (0.4, 0.3);
/// Greatest spin in rad/s and torque in N·m of a wheel, and angle of steering in rad.
const DRIVE: (f32, f32, f32) = (40.0, 400.0, 0.5);

fn main() {
    let scenery = Scenery::new(Vec3::new(0.0, 6.0, 14.0), Vec3::ZERO).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_systems(Startup, (spawn_car, spawn_bumps))
        .add_systems(FixedUpdate, drive)
        .add_systems(Update, show_speed)
        .run();
}

fn spawn_car(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let size = Vec3::new(1.6, 0.5, 3.6);
    let chassis = commands.spawn((
        RigidBody::Dynamic,
        Collider::cuboid(size.x, size.y, size.z),
        ColliderDensity(300.0),
        Transform::from_xyz(0.0, 1.2, 6.0),
        Mesh3d(meshes.add(Cuboid::from_size(size))),
        MeshMaterial3d(materials.add(Color::srgb(0.7, 0.25, 0.2))),
        Car,
    ));
    let chassis = chassis.id();
    let mesh = meshes.add(Cylinder::new(WHEEL.0, WHEEL.1));
    let color = materials.add(Color::srgb(0.15, 0.15, 0.15));
    // In N/m and N·s/m: four of them sag by 11 cm under the chassis.
    let spring = MotorModel::ForceBased { stiffness: 20_000.0, damping: 2_000.0 };
    let engine = MotorModel::AccelerationBased { stiffness: 0.0, damping: 10.0 };
    let steering = AngularMotor::new(MotorModel::SpringDamper { frequency: 10.0, damping_ratio: 1.0 });
    for (x, z) in [(-1.0, -1.2), (1.0, -1.2), (-1.0, 1.2), (1.0, 1.2)] {
        let at = Vec3::new(x, -0.4, z);
        // A cylinder along its axle, which is the x axis.
        let turn = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
        let wheel = commands.spawn((
            RigidBody::Dynamic,
            Collider::cylinder(WHEEL.0, WHEEL.1),
            ColliderDensity(150.0),
            Friction::new(1.2),
            Transform::from_translation(Vec3::new(0.0, 1.2, 6.0) + at).with_rotation(turn),
            Mesh3d(mesh.clone()),
            MeshMaterial3d(color.clone()),
        ));
        let joint = WheelJoint::new(chassis, wheel.id())
            .with_local_anchor1(at)
            .with_local_basis2(turn.inverse())
            .with_suspension(LinearMotor::new(spring))
            .with_suspension_limits(-0.2, 0.2)
            .with_motor(AngularMotor::new(engine).with_max_torque(DRIVE.1));
        // The front is at negative z.
        let joint = if z < 0.0 { joint.with_steering(steering) } else { joint };
        commands.spawn((joint, JointCollisionDisabled));
    }
}

#[derive(Component)]
struct Car;

fn drive(keys: Res<ButtonInput<KeyCode>>, mut wheels: Query<&mut WheelJoint>) {
    let is_down = |codes: [KeyCode; 2]| f32::from(u8::from(keys.any_pressed(codes)));
    let forward = is_down([KeyCode::KeyW, KeyCode::ArrowUp]) - is_down([KeyCode::KeyS, KeyCode::ArrowDown]);
    let left = is_down([KeyCode::KeyA, KeyCode::ArrowLeft]) - is_down([KeyCode::KeyD, KeyCode::ArrowRight]);
    for mut wheel in &mut wheels {
        wheel.motor.target_velocity = -DRIVE.0 * forward;
        wheel.steering.target_position = DRIVE.2 * left;
    }
}

fn show_speed(cars: Query<&LinearVelocity, With<Car>>, mut readout: Single<&mut Text, With<Readout>>) {
    for velocity in &cars {
        readout.0 = format!("{:.0} km/h", 3.6 * velocity.length());
    }
}

fn spawn_bumps(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let (mesh, color) = (meshes.add(Capsule3d::new(0.2, 2.0)), materials.add(Color::srgb(0.5, 0.5, 0.3)));
    for i in 0..8 {
        commands.spawn((
            RigidBody::Static,
            Collider::capsule(0.2, 2.0),
            Transform::from_xyz(if i % 2 == 0 { -1.2 } else { 1.2 }, -0.05, 1.0 - 1.5 * i as f32)
                .with_rotation(Quat::from_rotation_z(core::f32::consts::FRAC_PI_2)),
            Mesh3d(mesh.clone()),
            MeshMaterial3d(color.clone()),
        ));
    }
}
