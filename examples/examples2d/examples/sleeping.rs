//! Sleeping bodies are drawn dark. Look at the pile: it falls asleep after half a second of rest, as a whole. Click, and a ball wakes
//! what it touches.
//!
//! `cargo run --release -p examples2d --example sleeping`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "Dark bodies sleep. The pile falls asleep as a whole, after half a second of rest.
Click: throw a ball that wakes what it touches.";

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::with_floor().with_hint(HINT)))
        .add_systems(Startup, setup)
        .add_systems(Update, (throw, paint))
        .run();
}

#[derive(Resource)]
struct Look {
    disc: Handle<Mesh>,
    awake: Handle<ColorMaterial>,
    asleep: Handle<ColorMaterial>,
}

fn throw(mut commands: Commands, buttons: Res<ButtonInput<MouseButton>>, look: Res<Look>) {
    if buttons.just_pressed(MouseButton::Left) {
        commands.spawn((
            RigidBody::Dynamic,
            Collider::circle(0.3),
            LinearVelocity(Vec2::new(15.0, 0.0)),
            Transform::from_xyz(-11.0, 2.0, 0.0),
            Mesh2d(look.disc.clone()),
            MeshMaterial2d(look.awake.clone()),
        ));
    }
}

/// Static bodies are neither awake nor asleep.
fn paint(
    mut bodies: Query<(&RigidBody, &mut MeshMaterial2d<ColorMaterial>, Has<Sleeping>)>,
    look: Res<Look>,
) {
    for (_, mut material, asleep) in bodies.iter_mut().filter(|(body, ..)| body.is_dynamic()) {
        let color = if asleep { &look.asleep } else { &look.awake };
        if material.0 != *color {
            material.0 = color.clone();
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let look = Look {
        disc: meshes.add(Circle::new(0.3)),
        awake: materials.add(Color::srgb(0.9, 0.6, 0.2)),
        asleep: materials.add(Color::srgb(0.3, 0.25, 0.2)),
    };
    let square = meshes.add(Rectangle::new(0.6, 0.6));
    for i in 0..55u32 {
        // A pyramid of ten layers.
        let layer = (0..10).find(|layer| i < (0..=*layer).map(|l| 10 - l).sum()).unwrap_or(9);
        let before: u32 = (0..layer).map(|l| 10 - l).sum();
        let x = (i - before) as f32 + 0.5 * layer as f32 - 4.5;
        commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(0.6, 0.6),
            Transform::from_xyz(0.65 * x, 0.3 + 0.6 * layer as f32, 0.0),
            Mesh2d(square.clone()),
            MeshMaterial2d(look.awake.clone()),
        ));
    }
    commands.insert_resource(look);
}
