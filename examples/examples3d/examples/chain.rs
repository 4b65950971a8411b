//! A chain of light links with a ball of a hundred times their mass, which swings into a wall of bricks. Look at the links: they stay
//! together, although the ball pulls at them.
//!
//! `cargo run --release -p examples3d --example chain`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// Length and number of links.
const LINK: (f32, usize) = (0.5, 12);
/// Radius of the ball in metres.
const BALL: f32 = 0.7;

/// On the screen.
const HINT: &str = "Links stay together, although the ball weighs a hundred times as much.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(3.0, 5.0, 16.0), Vec3::new(0.0, 4.0, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_systems(Startup, (hang_chain, build_wall))
        .run();
}

fn hang_chain(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let (length, count) = LINK;
    let start = Vec3::new(0.0, 8.0, 0.0);
    let mut last = commands.spawn((RigidBody::Static, Transform::from_translation(start))).id();
    let mesh = meshes.add(Capsule3d::new(0.08, length - 0.16));
    let color = materials.add(Color::srgb(0.7, 0.7, 0.75));
    for i in 0..count {
        let link = commands.spawn((
            RigidBody::Dynamic,
            Collider::capsule(0.08, length - 0.16),
            // Level, so that the chain swings down.
            Transform::from_translation(start - Vec3::X * length * (i as f32 + 0.5))
                .with_rotation(Quat::from_rotation_z(-core::f32::consts::FRAC_PI_2)),
            Mesh3d(mesh.clone()),
            MeshMaterial3d(color.clone()),
        ));
        let link = link.id();
        let joint = SphericalJoint::new(last, link).with_anchor(start - Vec3::X * length * i as f32);
        commands.spawn((joint, JointCollisionDisabled));
        last = link;
    }
    let end = start - Vec3::X * length * count as f32;
    let ball = commands.spawn((
        RigidBody::Dynamic,
        Collider::sphere(BALL),
        Transform::from_translation(end - Vec3::X * BALL),
        Mesh3d(meshes.add(Sphere::new(BALL))),
        MeshMaterial3d(materials.add(Color::srgb(0.85, 0.45, 0.3))),
    ));
    let ball = ball.id();
    commands.spawn((SphericalJoint::new(last, ball).with_anchor(end), JointCollisionDisabled));
}

fn build_wall(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let size = Vec3::new(0.5, 0.5, 1.0);
    let mesh = meshes.add(Cuboid::from_size(size));
    let colors = [0.0, 0.05].map(|light| materials.add(Color::srgb(0.6 + light, 0.3 + light, 0.25)));
    for row in 0..8 {
        for column in 0..4 {
            let shift = 0.5 * (row % 2) as f32;
            commands.spawn((
                RigidBody::Dynamic,
                Collider::cuboid(size.x, size.y, size.z),
                Transform::from_xyz(2.5, 0.25 + 0.5 * row as f32, column as f32 - 1.75 + shift),
                Mesh3d(mesh.clone()),
                MeshMaterial3d(colors[(row + column) % 2].clone()),
            ));
        }
    }
}
