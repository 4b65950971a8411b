//! Coins and a pressure plate. Look at the coins: the ball takes each that it touches, told by an observer on the coin.
//! The door on the right is open while something lies on the plate. A second sensor keeps it open while something is in
//! the doorway. Arrow keys or A and D push the ball, space lets it jump.
//!
//! `cargo run --release -p examples2d --example collision_events`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "\
The ball takes the coins that it touches. The door is open while something lies on the green plate:
push the crate there.
Left, Right or A, D: push the ball. Space: jump.";

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    app.add_plugins((PhysicsPlugins::default(), Scenery::with_floor().with_hint(HINT)))
        .add_systems(Startup, setup)
        .add_systems(Update, push)
        .add_systems(FixedUpdate, move_door);
}

#[derive(Component)]
pub(crate) struct Ball;

/// A sensor that opens the door: the plate, and the doorway, so that the door crushes nothing.
#[derive(Component)]
struct Opener;

#[derive(Component)]
pub(crate) struct Door;

/// Runs for the coin that is touched, with the coin as the first collider.
fn take(event: On<CollisionStart>, balls: Query<(), With<Ball>>, mut commands: Commands) {
    if balls.contains(event.collider2) {
        commands.entity(event.collider1).despawn();
    }
}

fn move_door(
    openers: Query<&CollidingEntities, With<Opener>>,
    bodies: Query<&RigidBody>,
    mut doors: Query<(&Position, &mut LinearVelocity), With<Door>>,
) {
    let mut touching = openers.iter().flat_map(|opener| bodies.iter_many(opener.iter()));
    let is_open = touching.any(RigidBody::is_dynamic);
    for (position, mut velocity) in &mut doors {
        let target = if is_open { 3.5 } else { 1.0 };
        velocity.y = (target - position.y).clamp(-1.0, 1.0) * 3.0;
    }
}

fn push(keys: Res<ButtonInput<KeyCode>>, mut balls: Query<&mut LinearVelocity, With<Ball>>, time: Res<Time>) {
    for mut velocity in &mut balls {
        let right = f32::from(keys.any_pressed([KeyCode::ArrowRight, KeyCode::KeyD]));
        let left = f32::from(keys.any_pressed([KeyCode::ArrowLeft, KeyCode::KeyA]));
        velocity.x += (right - left) * 12.0 * time.delta_secs();
        if keys.just_pressed(KeyCode::Space) {
            velocity.y += 6.0;
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let mut material = |r, g, b| MeshMaterial2d(materials.add(Color::srgb(r, g, b)));
    commands.spawn((
        Ball,
        RigidBody::Dynamic,
        Collider::circle(0.4),
        LinearVelocity(Vec2::new(5.0, 0.0)),
        Transform::from_xyz(-9.0, 1.0, 0.0),
        Mesh2d(meshes.add(Circle::new(0.4))),
        material(0.9, 0.5, 0.3),
    ));
    for i in 0..8 {
        commands
            .spawn((
                Sensor,
                Collider::circle(0.25),
                CollisionEventsEnabled,
                Transform::from_xyz(-7.0 + 1.2 * i as f32, 0.5, 0.0),
                Mesh2d(meshes.add(Circle::new(0.25))),
                material(1.0, 0.85, 0.2),
            ))
            .observe(take);
    }
    let opener =
        |size: Vec2| (Opener, Sensor, Collider::rectangle(size.x, size.y), CollidingEntities::default());
    commands.spawn((
        opener(Vec2::new(2.0, 0.2)),
        Transform::from_xyz(5.0, 0.1, 0.0),
        Mesh2d(meshes.add(Rectangle::new(2.0, 0.2))),
        material(0.3, 0.8, 0.5),
    ));
    commands.spawn((opener(Vec2::new(1.0, 2.4)), Transform::from_xyz(8.0, 1.2, 0.0)));
    commands.spawn((
        RigidBody::Dynamic,
        Collider::rectangle(0.8, 0.8),
        Transform::from_xyz(3.0, 0.4, 0.0),
        Mesh2d(meshes.add(Rectangle::new(0.8, 0.8))),
        material(0.7, 0.55, 0.4),
    ));
    commands.spawn((
        Door,
        RigidBody::Kinematic,
        Collider::rectangle(0.4, 2.0),
        Transform::from_xyz(8.0, 1.0, 0.0),
        Mesh2d(meshes.add(Rectangle::new(0.4, 2.0))),
        material(0.5, 0.5, 0.7),
    ));
}
