//! A platform carries boxes to and fro. Look at the boxes: friction takes them along, because the platform is kinematic and
//! moves by its velocity. It turns gently, with less acceleration than friction can give.
//!
//! `cargo run --release -p examples2d --example moving_platform`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "The platform is kinematic and moves by its velocity. Friction takes the boxes along.";

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    app.add_plugins((PhysicsPlugins::default(), Scenery::with_floor().with_hint(HINT)))
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, swing);
}

#[derive(Component)]
pub(crate) struct Platform;

/// How far the platform goes to each side, in metres.
const REACH: f32 = 5.0;
/// Rate of its swing in rad/s. The largest acceleration is REACH · PACE², 1.25 m/s²; friction of 0.5 holds up to 4.9 m/s².
const PACE: f32 = 0.5;

/// Sets the velocity with which the platform is in the right place after the step.
fn swing(time: Res<Time>, mut platforms: Query<(&Position, &mut LinearVelocity), With<Platform>>) {
    for (position, mut velocity) in &mut platforms {
        let next = -REACH * (PACE * (time.elapsed_secs() + time.delta_secs())).cos();
        velocity.x = (next - position.x) / time.delta_secs();
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    commands.spawn((
        Platform,
        RigidBody::Kinematic,
        Collider::rectangle(4.0, 0.4),
        Transform::from_xyz(-REACH, 3.0, 0.0),
        Mesh2d(meshes.add(Rectangle::new(4.0, 0.4))),
        MeshMaterial2d(materials.add(Color::srgb(0.5, 0.55, 0.6))),
    ));
    let square = meshes.add(Rectangle::new(0.5, 0.5));
    let amber = materials.add(Color::srgb(0.9, 0.6, 0.2));
    for i in 0..9 {
        commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(0.5, 0.5),
            Transform::from_xyz((i % 3) as f32 - 1.0 - REACH, 3.5 + 0.6 * (i / 3) as f32, 0.0),
            Mesh2d(square.clone()),
            MeshMaterial2d(amber.clone()),
        ));
    }
}
