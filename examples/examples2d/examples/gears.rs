//! A machine of gears. Look at the spokes: the first wheel has a motor, the others follow by the ratio of their radii, the last moves a
//! rack, and two weights hang on a rope over pulleys. Nothing slips, whatever the load. Space turns the motor round.
//!
//! `cargo run --release -p examples2d --example gears`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "\
The first wheel has a motor. Gears turn the others and move the rack; a rope over pulleys ties two weights.
Space: turn the motor round.";

/// Radii of the wheels in metres, from the left.
const RADII: [f32; 4] = [0.8, 1.6, 0.5, 1.0];

/// The hinge with the motor.
#[derive(Component)]
struct Driven;

fn main() {
    let scenery = Scenery::default().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDebugPlugin, scenery))
        .add_systems(Startup, (build_gears, hang_weights))
        .add_systems(Update, turn_round)
        .run();
}

fn build_gears(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let spoke = (meshes.add(Rectangle::new(0.1, 1.0)), materials.add(Color::srgb(0.9, 0.9, 0.9)));
    let (mut last, mut x) = (None, -8.0);
    for (i, radius) in RADII.into_iter().enumerate() {
        x += radius;
        let at = Transform::from_xyz(x, 6.0, 0.0);
        let post = commands.spawn((RigidBody::Static, at)).id();
        let wheel = commands.spawn((
            RigidBody::Dynamic,
            Collider::circle(radius),
            at,
            Mesh2d(meshes.add(Circle::new(radius))),
            MeshMaterial2d(materials.add(Color::hsl(60.0 * i as f32, 0.4, 0.45))),
        ));
        let wheel = wheel.id();
        let mark = Transform::from_xyz(0.0, 0.5 * radius, 0.1).with_scale(Vec3::new(1.0, radius, 1.0));
        commands.spawn((Mesh2d(spoke.0.clone()), MeshMaterial2d(spoke.1.clone()), mark, ChildOf(wheel)));
        let hinge = RevoluteJoint::new(post, wheel);
        match last {
            None => {
                let model = MotorModel::AccelerationBased { stiffness: 0.0, damping: 5.0 };
                let motor = AngularMotor::new(model).with_target_velocity(2.0);
                commands.spawn((hinge.with_motor(motor), Driven));
            }
            Some((other, other_radius)) => {
                commands.spawn(hinge);
                let gear = GearJoint::new(other, wheel).with_radii(other_radius, radius);
                commands.spawn((gear, JointCollisionDisabled));
            }
        }
        last = Some((wheel, radius));
        x += radius;
    }
    // Below the last wheel.
    if let Some((pinion, radius)) = last {
        let at = Transform::from_xyz(x - radius, 6.0 - radius - 0.15, 0.0);
        let post = commands.spawn((RigidBody::Static, at)).id();
        let rack = commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(8.0, 0.3),
            at,
            Mesh2d(meshes.add(Rectangle::new(8.0, 0.3))),
            MeshMaterial2d(materials.add(Color::srgb(0.5, 0.5, 0.55))),
        ));
        let rack = rack.id();
        // The machine stops where the rack does.
        commands.spawn(PrismaticJoint::new(post, rack).with_limits(-3.0, 3.0));
        commands.spawn((RackAndPinionJoint::new(pinion, rack).with_radius(radius), JointCollisionDisabled));
    }
}

fn hang_weights(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let weights = [(-3.0, 0.8), (0.0, 0.7)].map(|(x, size)| {
        let weight = commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(size, size),
            Transform::from_xyz(x, 1.0, 0.0),
            Mesh2d(meshes.add(Rectangle::new(size, size))),
            MeshMaterial2d(materials.add(Color::srgb(0.3, 0.5, 0.7))),
        ));
        weight.id()
    });
    let pulleys = [Vec2::new(-3.0, 3.5), Vec2::new(0.0, 3.5)];
    commands.spawn(PulleyJoint::new(weights[0], weights[1], pulleys));
}

fn turn_round(keys: Res<ButtonInput<KeyCode>>, mut hinges: Query<&mut RevoluteJoint, With<Driven>>) {
    if keys.just_pressed(KeyCode::Space) {
        for mut hinge in &mut hinges {
            hinge.motor.target_velocity = -hinge.motor.target_velocity;
        }
    }
}
