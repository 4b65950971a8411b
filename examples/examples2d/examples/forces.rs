//! Three rockets with the same thrust in space. Look at their ways: the force on the first is along an axis of the world, so it flies
//! straight while it spins. The thrust of the second is along its own axis, which turns, so it flies in a circle. The third gets
//! the thrust of a second in one impulse, and keeps up with the first in jerks.
//!
//! `cargo run --release -p examples2d --example forces`

use avian2d::prelude::*;
use bevy::{prelude::*, time::common_conditions::on_timer};
use examples2d::Scenery;
use std::time::Duration;

/// Thrust in N. With 4 kg it accelerates by 0.1 m/s².
const THRUST: f32 = 0.4;
/// The rate at which the first two spin, in rad/s.
const SPIN: f32 = 0.25;
/// Length of a trail in points.
const TRAIL: usize = 2000;

/// A rocket that gets impulses.
#[derive(Component)]
struct Pulsing;

/// Where a rocket was.
#[derive(Component, Default)]
struct Trail(Vec<Vec2>);

/// On the screen.
const HINT: &str = "\
The same thrust in three ways: along an axis of the world, along the rocket's own axis, in impulses.";

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::default().with_hint(HINT)))
        .insert_resource(Gravity::ZERO)
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, push.run_if(on_timer(Duration::from_secs(1))))
        .add_systems(FixedLast, remember)
        .add_systems(Update, draw)
        .run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let mesh = meshes.add(Triangle2d::new(Vec2::new(-0.4, -0.6), Vec2::new(0.4, -0.6), Vec2::new(0.0, 0.8)));
    let colors = [Color::srgb(0.9, 0.6, 0.2), Color::srgb(0.2, 0.65, 0.6), Color::srgb(0.7, 0.4, 0.7)];
    let rockets = colors.map(|color| {
        let rocket = (
            RigidBody::Dynamic,
            Mass(4.0),
            AngularInertia(1.0),
            Trail::default(),
            Mesh2d(mesh.clone()),
            MeshMaterial2d(materials.add(color)),
        );
        commands.spawn(rocket).id()
    });
    let [straight, circling, pulsing] = rockets;
    commands.entity(straight).insert((
        ConstantForce::new(0.0, THRUST),
        AngularVelocity(SPIN),
        Transform::from_xyz(-5.0, -1.0, 0.0),
    ));
    commands.entity(circling).insert((
        ConstantLocalForce::new(0.0, THRUST),
        AngularVelocity(SPIN),
        // With a / ω across the thrust the way is a circle of radius a / ω².
        LinearVelocity(Vec2::X * 0.1 / SPIN),
        Transform::from_xyz(0.0, 3.0, 0.0),
    ));
    commands.entity(pulsing).insert((Pulsing, Transform::from_xyz(5.0, -1.0, 0.0)));
}

fn push(mut rockets: Query<Forces, With<Pulsing>>) {
    for mut forces in &mut rockets {
        forces.apply_local_linear_impulse(Vec2::Y * THRUST);
    }
}

fn remember(mut trails: Query<(&Position, &mut Trail)>) {
    for (position, mut trail) in &mut trails {
        trail.0.push(position.0);
        let excess = trail.0.len().saturating_sub(TRAIL);
        trail.0.drain(..excess);
    }
}

fn draw(trails: Query<&Trail>, mut gizmos: Gizmos) {
    for trail in &trails {
        gizmos.linestrip_2d(trail.0.iter().copied(), Color::srgb(0.5, 0.5, 0.5));
    }
}
