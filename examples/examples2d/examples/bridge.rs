//! A bridge of planks on hinges that break. Look at the planks: they turn red as they bear more, and the bridge tears where a hinge
//! bears more than its threshold. Space drops another, heavier ball.
//!
//! `cargo run --release -p examples2d --example bridge`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "\
Hinges of the bridge redden with the load that they bear, and break above their threshold.
Space: drop a ball. Each is heavier than the last.";

/// Number of planks, and the force in N that breaks a hinge.
const BRIDGE: (usize, f32) = (20, 400.0);

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::default().with_hint(HINT)))
        .add_systems(Startup, build)
        .add_systems(Update, (drop_ball, show_load))
        .add_observer(clear_away)
        .run();
}

fn build(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let mesh = meshes.add(Rectangle::new(0.8, 0.2));
    let end = |x: f32| (RigidBody::Static, Transform::from_xyz(x, 5.0, 0.0));
    let mut last = commands.spawn(end(-8.0)).id();
    for i in 0..=BRIDGE.0 {
        let x = -8.0 + 0.8 * i as f32;
        let next = if i == BRIDGE.0 {
            commands.spawn(end(8.0)).id()
        } else {
            let plank = commands.spawn((
                RigidBody::Dynamic,
                Collider::rectangle(0.8, 0.2),
                Transform::from_xyz(x + 0.4, 5.0, 0.0),
                Mesh2d(mesh.clone()),
                MeshMaterial2d(materials.add(Color::WHITE)),
            ));
            plank.id()
        };
        commands.spawn((
            RevoluteJoint::new(last, next).with_anchor(Vec2::new(x, 5.0)),
            JointCollisionDisabled,
            JointBreakThreshold::force(BRIDGE.1),
        ));
        last = next;
    }
}

/// A broken hinge is disabled; here it is never mended.
fn clear_away(broken: On<JointBroken>, mut commands: Commands) {
    info!("a hinge broke by {:.0} N", broken.force.length());
    commands.entity(broken.joint).despawn();
}

fn show_load(
    hinges: Query<(&RevoluteJoint, &JointForces)>,
    planks: Query<&MeshMaterial2d<ColorMaterial>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    for (hinge, forces) in &hinges {
        let load = forces.force().length() / BRIDGE.1;
        if let Ok(handle) = planks.get(hinge.body1)
            && let Some(mut material) = materials.get_mut(handle)
        {
            material.color = Color::srgb(0.5 + 0.5 * load, 0.5 * (1.0 - load), 0.3 * (1.0 - load));
        }
    }
}

fn drop_ball(
    keys: Res<ButtonInput<KeyCode>>,
    mut count: Local<u8>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    if keys.just_pressed(KeyCode::Space) {
        *count += 1;
        let radius = 0.3 + 0.1 * f32::from(*count);
        commands.spawn((
            RigidBody::Dynamic,
            Collider::circle(radius),
            ColliderDensity(2.0),
            Transform::from_xyz(2.0 * f32::from(*count % 3) - 2.0, 9.0, 0.0),
            Mesh2d(meshes.add(Circle::new(radius))),
            MeshMaterial2d(materials.add(Color::srgb(0.3, 0.5, 0.7))),
        ));
    }
}
