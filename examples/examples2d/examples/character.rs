//! A character of a platform game: stairs, slopes, a lift and crates. A and D or the arrow keys walk, Space jumps; a gamepad's left
//! stick and south button do the same. Look at the feet on the steps, and at the jump from the lift.
//!
//! `cargo run --release -p examples2d --example character`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "Walk: A, D, arrows or left stick. Jump: space or south button.\n\
    Take the stairs at full speed, push the crates, jump from the lift as it rises.";

fn main() {
    let scenery = Scenery::with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .add_systems(Update, walk)
        .add_systems(FixedUpdate, turn_lift_round)
        .run();
}

#[derive(Component)]
struct Player;

#[derive(Component)]
struct Lift;

fn walk(
    keys: Res<ButtonInput<KeyCode>>,
    pads: Query<&Gamepad>,
    mut players: Query<(&mut CharacterInput, &CharacterState), With<Player>>,
) {
    let held = |pair: [KeyCode; 2]| f32::from(keys.any_pressed(pair));
    let stick: f32 = pads.iter().map(|pad| pad.left_stick().x).sum();
    let way = held([KeyCode::KeyD, KeyCode::ArrowRight]) - held([KeyCode::KeyA, KeyCode::ArrowLeft]) + stick;
    let jumps =
        keys.just_pressed(KeyCode::Space) || pads.iter().any(|pad| pad.just_pressed(GamepadButton::South));
    for (mut input, state) in &mut players {
        input.velocity = Vec2::X * (4.0 * way.clamp(-1.0, 1.0));
        if jumps && state.is_grounded() {
            input.jump = 6.0;
        }
    }
}

fn turn_lift_round(mut lifts: Query<(&Position, &mut LinearVelocity), With<Lift>>) {
    for (position, mut velocity) in &mut lifts {
        if (position.y < 0.2 && velocity.y < 0.0) || (position.y > 3.0 && velocity.y > 0.0) {
            velocity.y = -velocity.y;
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let [grey, blue, amber] = [[0.5, 0.55, 0.6], [0.3, 0.5, 0.8], [0.9, 0.6, 0.2]]
        .map(|c| materials.add(Color::srgb_from_array(c)));
    commands.spawn((
        Player,
        CharacterController::default(),
        Collider::capsule(0.4, 1.0),
        Transform::from_xyz(0.0, 1.5, 1.0),
        TransformInterpolation,
        Mesh2d(meshes.add(Capsule2d::new(0.4, 1.0))),
        MeshMaterial2d(blue.clone()),
    ));
    let mut block = |size: Vec2, place: Transform| {
        (Collider::rectangle(size.x, size.y), place, Mesh2d(meshes.add(Rectangle::from_size(size))))
    };
    for i in 0..8 {
        let height = 0.3 * (i + 1) as f32;
        let place = Transform::from_xyz(-2.0 - 0.4 * i as f32, 0.5 * height, 0.0);
        commands.spawn((
            RigidBody::Static,
            block(Vec2::new(0.4, height), place),
            MeshMaterial2d(grey.clone()),
        ));
    }
    let slope = Transform::from_xyz(4.0, 0.4, 0.0).with_rotation(Quat::from_rotation_z(0.5));
    commands.spawn((RigidBody::Static, block(Vec2::new(4.0, 0.4), slope), MeshMaterial2d(grey.clone())));
    for i in 0..3u8 {
        let crates = block(Vec2::splat(0.6), Transform::from_xyz(1.0 + 0.7 * f32::from(i), 0.3, 0.0));
        commands.spawn((RigidBody::Dynamic, Mass(20.0), crates, MeshMaterial2d(amber.clone())));
    }
    let lift = block(Vec2::new(2.0, 0.3), Transform::from_xyz(8.0, 0.2, 0.0));
    let up = LinearVelocity(Vec2::Y);
    commands.spawn((Lift, RigidBody::Kinematic, up, TransformInterpolation, lift, MeshMaterial2d(grey)));
}
