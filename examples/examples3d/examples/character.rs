//! A character walks up stairs and slopes, rides a carousel and a lift, and pushes crates. WASD or the arrow keys walk, Space jumps;
//! a gamepad's left stick and south button do the same. Look at the feet on the steps, and at the turn of the carousel.
//!
//! `cargo run --release -p examples3d --example character`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "Walk: WASD, arrows or left stick. Jump: space or south button.\n\
    Take the stairs at full speed, push the crates, stand on the carousel and on the lift.";

fn main() {
    let scenery = Scenery::new(Vec3::new(0.0, 9.0, 16.0), Vec3::new(0.0, 1.0, 0.0));
    let scenery = scenery.with_floor().with_hint(HINT);
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
    let mut way = Vec2::new(
        held([KeyCode::KeyD, KeyCode::ArrowRight]) - held([KeyCode::KeyA, KeyCode::ArrowLeft]),
        held([KeyCode::KeyW, KeyCode::ArrowUp]) - held([KeyCode::KeyS, KeyCode::ArrowDown]),
    );
    way += pads.iter().map(Gamepad::left_stick).sum::<Vec2>();
    let way = way.clamp_length_max(1.0) * 4.0;
    let jumps =
        keys.just_pressed(KeyCode::Space) || pads.iter().any(|pad| pad.just_pressed(GamepadButton::South));
    for (mut input, state) in &mut players {
        input.velocity = Vec3::new(way.x, 0.0, -way.y);
        if jumps && state.is_grounded() {
            input.jump = 5.0;
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
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let [grey, blue, amber] = [[0.5, 0.55, 0.6], [0.3, 0.5, 0.8], [0.9, 0.6, 0.2]]
        .map(|c| materials.add(Color::srgb_from_array(c)));
    commands.spawn((
        Player,
        CharacterController::default(),
        Collider::capsule(0.4, 1.0),
        Transform::from_xyz(0.0, 1.5, 4.0),
        TransformInterpolation,
        Mesh3d(meshes.add(Capsule3d::new(0.4, 1.0))),
        MeshMaterial3d(blue.clone()),
    ));
    let mut block = |size: Vec3, place: Transform| {
        (Collider::cuboid(size.x, size.y, size.z), place, Mesh3d(meshes.add(Cuboid::from_size(size))))
    };
    let grey = MeshMaterial3d(grey);
    for i in 0..8 {
        let height = 0.3 * (i + 1) as f32;
        let place = Transform::from_xyz(-3.0 - 0.4 * i as f32, 0.5 * height, -1.0);
        commands.spawn((RigidBody::Static, block(Vec3::new(0.4, height, 3.0), place), grey.clone()));
    }
    let slope = Transform::from_xyz(-7.0, 1.1, 2.5).with_rotation(Quat::from_rotation_z(0.6));
    commands.spawn((RigidBody::Static, block(Vec3::new(5.0, 0.3, 2.0), slope), grey.clone()));
    for i in 0..6u8 {
        let place = Transform::from_xyz(3.0 + f32::from(i % 3), 0.4 + 0.8 * f32::from(i / 3), 4.0);
        let crates = block(Vec3::splat(0.8), place);
        commands.spawn((RigidBody::Dynamic, Mass(20.0), crates, MeshMaterial3d(amber.clone())));
    }
    let lift = block(Vec3::new(2.0, 0.3, 2.0), Transform::from_xyz(0.0, 0.2, -4.0));
    let up = LinearVelocity(Vec3::Y);
    commands.spawn((Lift, RigidBody::Kinematic, up, TransformInterpolation, lift, MeshMaterial3d(blue)));
    commands.spawn((
        RigidBody::Kinematic,
        AngularVelocity(Vec3::Y * 0.8),
        TransformInterpolation,
        Collider::cylinder(3.0, 0.3),
        Transform::from_xyz(6.0, 0.15, -3.0),
        Mesh3d(meshes.add(Cylinder::new(3.0, 0.3))),
        grey,
    ));
}
