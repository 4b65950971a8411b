//! Physics takes ten steps a second. Look at the two discs: the lower one jumps from step to step, the upper one is eased between
//! steps by `TransformInterpolation`.
//!
//! `cargo run --release -p examples2d --example interpolation`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "Physics takes ten steps a second. The lower disc jumps, the upper one is interpolated.";

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::default().with_hint(HINT)))
        .insert_resource(Time::<Fixed>::from_hz(10.0))
        .insert_resource(Gravity::ZERO)
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, turn_round)
        .run();
}

fn turn_round(mut bodies: Query<(&Position, &mut LinearVelocity)>) {
    for (position, mut velocity) in &mut bodies {
        if position.x.abs() > 6.0 && position.x * velocity.x > 0.0 {
            velocity.x = -velocity.x;
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let disc = meshes.add(Circle::new(0.8));
    let teal = materials.add(Color::srgb(0.2, 0.65, 0.6));
    for y in [3.5, 6.5] {
        let mut body = commands.spawn((
            RigidBody::Dynamic,
            Collider::circle(0.8),
            LinearVelocity(Vec2::new(6.0, 0.0)),
            Transform::from_xyz(0.0, y, 0.0),
            Mesh2d(disc.clone()),
            MeshMaterial2d(teal.clone()),
        ));
        if y > 5.0 {
            body.insert(TransformInterpolation);
        }
    }
}
