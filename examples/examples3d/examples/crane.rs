//! A crane whose joints do not give way, by [`JointSolver::Rigid`]. Look at the tip of the boom: twelve light beams, welded end to end,
//! carry a load of 20 times their mass on a rope. A and D turn it, W and S haul the rope in and let it out. R switches to the default,
//! in which the boom bends.
//!
//! `cargo run --release -p examples3d --example crane`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::{Readout, Scenery};

/// On the screen.
const HINT: &str = "\
A boom of welded beams carries 20 times its mass.
A, D: turn. W, S: rope in and out. R: switch between Rigid and Auto.";

/// Height of the mast, length of a beam, both in m, and number of beams.
const CRANE: (f32, f32, usize) = (8.0, 0.75, 12);

/// The tip of the boom.
#[derive(Component)]
struct Tip;

fn main() {
    let scenery =
        Scenery::new(Vec3::new(6.0, 8.0, 20.0), Vec3::new(2.0, 5.0, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDebugPlugin, scenery))
        .insert_resource(JointSolver::Rigid)
        .add_systems(Startup, build)
        .add_systems(FixedUpdate, (turn, haul))
        .add_systems(Update, (switch, show_sag))
        .run();
}

fn build(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let (height, length, count) = CRANE;
    let steel = materials.add(Color::srgb(0.8, 0.65, 0.2));
    let mut beam = |commands: &mut Commands, at: Vec3, size: Vec3, mass: f32| {
        let beam = commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(size.x, size.y, size.z),
            Mass(mass),
            Transform::from_translation(at),
            Mesh3d(meshes.add(Cuboid::from_size(size))),
            MeshMaterial3d(steel.clone()),
            // What hangs on a motor is not to fall asleep before the next key.
            SleepingDisabled,
        ));
        beam.id()
    };
    let ground = commands.spawn((RigidBody::Static, Transform::from_xyz(0.0, height, 0.0))).id();
    let mast = beam(&mut commands, Vec3::Y * 0.5 * height, Vec3::new(0.6, height, 0.6), 200.0);
    let motor = MotorModel::AccelerationBased { stiffness: 0.0, damping: 5.0 };
    let hinge =
        RevoluteJoint::new(ground, mast).with_hinge_axis(Vec3::Y).with_local_anchor2(Vec3::Y * 0.5 * height);
    commands.spawn(hinge.with_motor(AngularMotor::new(motor)));

    let (mut last, mut end) = (mast, Vec3::Y * height);
    for _ in 0..count {
        let next = beam(&mut commands, end + Vec3::X * 0.5 * length, Vec3::new(length, 0.3, 0.3), 2.0);
        commands.spawn((FixedJoint::new(last, next).with_anchor(end), JointCollisionDisabled));
        (last, end) = (next, end + Vec3::X * length);
    }
    commands.entity(last).insert(Tip);
    let load = beam(&mut commands, end - Vec3::Y * 4.0, Vec3::ONE, 500.0);
    let rope = DistanceJoint::rope(last, load, 3.5);
    commands.spawn(rope.with_local_anchor1(Vec3::X * 0.5 * length).with_local_anchor2(Vec3::Y * 0.5));
}

fn turn(keys: Res<ButtonInput<KeyCode>>, mut hinges: Query<&mut RevoluteJoint>) {
    let is_down = |code| f32::from(u8::from(keys.pressed(code)));
    for mut hinge in &mut hinges {
        hinge.motor.target_velocity = 0.4 * (is_down(KeyCode::KeyA) - is_down(KeyCode::KeyD));
    }
}

fn haul(keys: Res<ButtonInput<KeyCode>>, time: Res<Time>, mut ropes: Query<&mut DistanceJoint>) {
    let is_down = |code| f32::from(u8::from(keys.pressed(code)));
    let change = (is_down(KeyCode::KeyS) - is_down(KeyCode::KeyW)) * time.delta_secs();
    for mut rope in &mut ropes {
        let length = (rope.limits.max + change).clamp(1.0, 7.0);
        if length != rope.limits.max {
            rope.limits.max = length;
        }
    }
}

fn switch(keys: Res<ButtonInput<KeyCode>>, mut solver: ResMut<JointSolver>) {
    if keys.just_pressed(KeyCode::KeyR) {
        *solver = if *solver == JointSolver::Rigid { JointSolver::Auto } else { JointSolver::Rigid };
    }
}

fn show_sag(
    tips: Query<&Position, With<Tip>>,
    solver: Res<JointSolver>,
    mut readout: Single<&mut Text, With<Readout>>,
) {
    for tip in &tips {
        readout.0 =
            format!("{:?}: the tip is {:.1} mm below the mast's top", *solver, 1000.0 * (CRANE.0 - tip.y));
    }
}
