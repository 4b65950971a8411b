//! Three boxes are hit by balls. Look at what each may do: the first moves freely, the second does not turn, the third moves along y
//! only.
//!
//! `cargo run --release -p examples2d --example locked_axes`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "What each box may do: move freely, not turn, move along y only.";

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::with_floor().with_hint(HINT)))
        .add_systems(Startup, setup)
        .run();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let (square, disc) = (meshes.add(Rectangle::new(1.0, 2.0)), meshes.add(Circle::new(0.3)));
    let amber = materials.add(Color::srgb(0.9, 0.6, 0.2));
    let teal = materials.add(Color::srgb(0.2, 0.65, 0.6));
    let locks = [
        LockedAxes::new(),
        LockedAxes::new().lock_rotation(),
        LockedAxes::new().lock_rotation().lock_translation_x(),
    ];
    for (i, locks) in locks.into_iter().enumerate() {
        let x = 6.0 * i as f32 - 6.0;
        commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(1.0, 2.0),
            locks,
            Transform::from_xyz(x, 1.0, 0.0),
            Mesh2d(square.clone()),
            MeshMaterial2d(amber.clone()),
        ));
        commands.spawn((
            RigidBody::Dynamic,
            Collider::circle(0.3),
            ColliderDensity(4.0),
            LinearVelocity(Vec2::new(6.0, 1.0)),
            Transform::from_xyz(x - 3.0, 1.7, 0.0),
            Mesh2d(disc.clone()),
            MeshMaterial2d(teal.clone()),
        ));
    }
}
