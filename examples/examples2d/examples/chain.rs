//! A chain of light links with a ball of fifty times their mass, and a bridge of planks with crates on it. Look at the links: they
//! stay together, although the ball pulls at them as it swings.
//!
//! `cargo run --release -p examples2d --example chain`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// Length of a link in metres.
const LINK: f32 = 0.4;
/// Length and number of planks.
const PLANK: (f32, usize) = (0.6, 16);

/// On the screen.
const HINT: &str = "Links stay together, although the ball weighs fifty times as much.";

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::default().with_hint(HINT)))
        .add_systems(Startup, (hang_chain, build_bridge))
        .run();
}

fn hang_chain(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let start = Vec2::new(-6.0, 9.5);
    let mut last = commands.spawn((RigidBody::Static, Transform::from_translation(start.extend(0.0)))).id();
    let mesh = meshes.add(Capsule2d::new(0.08, LINK - 0.16));
    let color = materials.add(Color::srgb(0.7, 0.7, 0.75));
    for i in 0..14 {
        let link = commands.spawn((
            RigidBody::Dynamic,
            Collider::capsule(0.08, LINK - 0.16),
            // Level, so that the chain swings down.
            Transform::from_translation((start - Vec2::X * LINK * (i as f32 + 0.5)).extend(0.0))
                .with_rotation(Quat::from_rotation_z(-core::f32::consts::FRAC_PI_2)),
            Mesh2d(mesh.clone()),
            MeshMaterial2d(color.clone()),
        ));
        let link = link.id();
        let joint = RevoluteJoint::new(last, link).with_anchor(start - Vec2::X * LINK * i as f32);
        commands.spawn((joint, JointCollisionDisabled));
        last = link;
    }
    let end = start - Vec2::X * LINK * 14.0;
    let ball = commands.spawn((
        RigidBody::Dynamic,
        Collider::circle(0.5),
        ColliderDensity(4.0),
        Transform::from_translation((end - Vec2::X * 0.5).extend(0.0)),
        Mesh2d(meshes.add(Circle::new(0.5))),
        MeshMaterial2d(materials.add(Color::srgb(0.85, 0.45, 0.3))),
    ));
    let ball = ball.id();
    commands.spawn((RevoluteJoint::new(last, ball).with_anchor(end), JointCollisionDisabled));
}

fn build_bridge(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let (length, count) = PLANK;
    let start = Vec2::new(0.5, 4.0);
    let ends = [0, count].map(|i| start + Vec2::X * length * i as f32);
    let posts = ends
        .map(|end| commands.spawn((RigidBody::Static, Transform::from_translation(end.extend(0.0)))).id());
    let mesh = meshes.add(Rectangle::new(length - 0.04, 0.2));
    let color = materials.add(Color::srgb(0.55, 0.4, 0.25));
    let mut last = posts[0];
    for i in 0..count {
        let middle = start + Vec2::X * length * (i as f32 + 0.5);
        let plank = commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(length - 0.04, 0.2),
            Transform::from_translation(middle.extend(0.0)),
            Mesh2d(mesh.clone()),
            MeshMaterial2d(color.clone()),
        ));
        let plank = plank.id();
        commands.spawn(RevoluteJoint::new(last, plank).with_anchor(middle - Vec2::X * 0.5 * length));
        last = plank;
    }
    commands.spawn(RevoluteJoint::new(last, posts[1]).with_anchor(ends[1]));
    let crates = [materials.add(Color::srgb(0.3, 0.6, 0.8)), materials.add(Color::srgb(0.3, 0.7, 0.5))];
    for i in 0..6 {
        commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(0.8, 0.8),
            Transform::from_translation(
                (start + Vec2::new(2.0 + 1.1 * i as f32, 2.0 + 0.3 * i as f32)).extend(0.0),
            ),
            Mesh2d(meshes.add(Rectangle::new(0.8, 0.8))),
            MeshMaterial2d(crates[i % 2].clone()),
        ));
    }
}
