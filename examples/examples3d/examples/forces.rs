//! A platform that hovers on four thrusters, and crates that fall on it. Look at how it tilts where a crate lands, and levels
//! again: each thruster pushes at its corner, harder the lower the corner is and the faster it sinks.
//!
//! `cargo run --release -p examples3d --example forces`

use avian3d::prelude::*;
use bevy::{prelude::*, time::common_conditions::on_timer};
use examples3d::Scenery;
use std::time::Duration;

/// Width and depth of the platform.
const SIDE: f32 = 6.0;
/// The height at which a thruster gives up.
const CEILING: f32 = 4.0;

/// A body with thrusters at its corners.
#[derive(Component)]
struct Hovering;

/// The number of crates.
#[derive(Resource, Default)]
struct Crates(u32);

/// On the screen.
const HINT: &str = "The platform hovers on four thrusters: it tilts where a crate lands, and levels again.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(0.0, 7.0, 14.0), Vec3::new(0.0, 2.5, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .init_resource::<Crates>()
        .add_systems(Startup, setup)
        // A force lasts one step. `FixedUpdate` runs once before each step.
        .add_systems(FixedUpdate, hover)
        .add_systems(Update, drop_crate.run_if(on_timer(Duration::from_secs(2))))
        .run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.spawn((
        Hovering,
        RigidBody::Dynamic,
        Collider::cuboid(SIDE, 0.3, SIDE),
        Mass(400.0),
        LinearDamping(0.3),
        AngularDamping(0.3),
        Transform::from_xyz(0.0, 2.0, 0.0),
        Mesh3d(meshes.add(Cuboid::new(SIDE, 0.3, SIDE))),
        MeshMaterial3d(materials.add(Color::srgb(0.2, 0.65, 0.6))),
    ));
}

fn hover(mut platforms: Query<Forces, With<Hovering>>) {
    for mut forces in &mut platforms {
        let up = *forces.rotation() * Vec3::Y;
        for (x, z) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            let arm = *forces.rotation() * Vec3::new(x, 0.0, z) * (0.5 * SIDE);
            let corner = forces.position().0 + arm;
            // A spring of 1 kN/m with a damper, which only pushes.
            let sinking = -forces.velocity_at_point(corner).y;
            let push = (CEILING - corner.y) * 1000.0 + sinking * 800.0;
            forces.apply_force_at_point(up * push.max(0.0), corner);
        }
    }
}

fn drop_crate(
    mut commands: Commands,
    mut crates: ResMut<Crates>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    if crates.0 == 12 {
        return;
    }
    crates.0 += 1;
    let angle = 2.4 * crates.0 as f32;
    commands.spawn((
        RigidBody::Dynamic,
        Collider::cuboid(0.7, 0.7, 0.7),
        Mass(30.0),
        Transform::from_xyz(2.0 * angle.cos(), 7.0, 2.0 * angle.sin()),
        Mesh3d(meshes.add(Cuboid::from_length(0.7))),
        MeshMaterial3d(materials.add(Color::srgb(0.9, 0.6, 0.2))),
    ));
}
