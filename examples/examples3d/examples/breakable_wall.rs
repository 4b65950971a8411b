//! A wall of bricks that are glued to each other by joints that break. Look at where the ball hits: only joints that bear more than their
//! threshold break. Space throws another ball, faster each time.
//!
//! `cargo run --release -p examples3d --example breakable_wall`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::{Readout, Scenery};

/// On the screen.
const HINT: &str = "\
Bricks are glued by joints that break above a threshold.
Space: throw a ball. Each is faster than the last.";

/// Numbers of bricks along and up, and their size in metres.
const WALL: (usize, usize, Vec3) = (8, 6, Vec3::new(1.0, 0.5, 0.5));
/// What a joint bears, in N and N·m.
const THRESHOLD: JointBreakThreshold = JointBreakThreshold::new(2000.0, 600.0);

/// How many joints broke.
#[derive(Resource, Default)]
struct Broken(usize);

fn main() {
    let scenery =
        Scenery::new(Vec3::new(6.0, 5.0, 12.0), Vec3::new(0.0, 1.5, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .init_resource::<Broken>()
        .add_systems(Startup, build)
        .add_systems(Update, (throw, count))
        .run();
}

fn build(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let (columns, rows, size) = WALL;
    let mesh = meshes.add(Cuboid::from_size(size));
    let colors = [0.0, 0.06].map(|light| materials.add(Color::srgb(0.6 + light, 0.3 + light, 0.25)));
    let mut bricks = Vec::new();
    for i in 0..columns * rows {
        let (column, row) = (i % columns, i / columns);
        let at = Vec3::new(column as f32 - 3.5, 0.25 + 0.5 * row as f32, 0.0);
        let brick = commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(size.x, size.y, size.z),
            ColliderDensity(20.0),
            Transform::from_translation(at),
            Mesh3d(mesh.clone()),
            MeshMaterial3d(colors[(row + column) % 2].clone()),
        ));
        let brick = brick.id();
        // To its neighbours at the left and below.
        let left = (column > 0).then(|| (bricks[i - 1], at - Vec3::X * 0.5));
        let below = (row > 0).then(|| (bricks[i - columns], at - Vec3::Y * 0.25));
        for (other, middle) in left.into_iter().chain(below) {
            commands.spawn((
                FixedJoint::new(other, brick).with_anchor(middle),
                THRESHOLD,
                JointCollisionDisabled,
            ));
        }
        bricks.push(brick);
    }
}

/// Counts the messages, and removes the joints.
fn count(
    mut events: MessageReader<JointBroken>,
    mut broken: ResMut<Broken>,
    mut commands: Commands,
    mut readout: Single<&mut Text, With<Readout>>,
) {
    for event in events.read() {
        broken.0 += 1;
        // Without it the bricks collide again.
        commands.entity(event.joint).despawn();
        readout.0 = format!("{} joints broke, the last by {:.0} N", broken.0, event.force.length());
    }
}

fn throw(
    keys: Res<ButtonInput<KeyCode>>,
    mut balls: Local<u8>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    if keys.just_pressed(KeyCode::Space) {
        *balls += 1;
        commands.spawn((
            RigidBody::Dynamic,
            Collider::sphere(0.4),
            ColliderDensity(100.0),
            Transform::from_xyz(1.5 * f32::from(*balls % 3) - 1.5, 1.5, 8.0),
            LinearVelocity(Vec3::NEG_Z * 8.0 * f32::from(*balls)),
            Mesh3d(meshes.add(Sphere::new(0.4))),
            MeshMaterial3d(materials.add(Color::srgb(0.3, 0.3, 0.35))),
        ));
    }
}
