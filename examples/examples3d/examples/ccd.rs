//! Continuous collision, three modes side by side. Look at the cubes that are shot at a thin turning plate, and at the counts:
//! without prediction and sweep most fly through. Behind is a static wall of 1 cm, which nothing passes in any mode. Space
//! changes the speed.
//!
//! `cargo run --release -p examples3d --example ccd`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::{Readout, Scenery};

/// On the screen.
const HINT: &str = "\
Cubes are shot at thin turning plates: without prediction and sweep, with prediction, with a sweep.
The static wall behind stops all of them.
Space: speed of the cubes.";

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    let scenery =
        Scenery::new(Vec3::new(5.0, 5.0, 8.5), Vec3::new(0.0, 1.2, -1.0)).with_floor().with_hint(HINT);
    app.add_plugins((PhysicsPlugins::default(), scenery))
        .insert_resource(Speed(100.0))
        .add_systems(Startup, setup)
        .add_systems(Update, (change_speed, draw_trails))
        .add_systems(FixedUpdate, (shoot, remove_old));
}

/// Of new cubes, in m/s.
#[derive(Resource)]
struct Speed(f32);

/// A cube of a mode, with its age.
#[derive(Component)]
pub(crate) struct Bullet {
    mode: usize,
    steps: u32,
}

#[derive(Resource)]
struct Look(Handle<Mesh>, [Handle<StandardMaterial>; 3]);

/// Name and place of each mode.
const MODES: [(&str, f32); 3] = [("neither", -4.0), ("prediction (default)", 0.0), ("sweep", 4.0)];
/// Side of a cube in metres.
const SIDE: f32 = 0.25;

fn shoot(mut commands: Commands, look: Res<Look>, speed: Res<Speed>, mut steps: Local<u32>) {
    *steps += 1;
    if !steps.is_multiple_of(8) {
        return;
    }
    for (mode, (_, x)) in MODES.into_iter().enumerate() {
        let mut cube = commands.spawn((
            Bullet { mode, steps: 0 },
            RigidBody::Dynamic,
            Collider::cuboid(SIDE, SIDE, SIDE),
            LinearVelocity(Vec3::new(0.0, 1.0, -speed.0)),
            AngularVelocity(Vec3::new(9.0, -7.0, 5.0)),
            // From other distances, so that not all are in the plate at the end of a step.
            Transform::from_xyz(
                x + 0.05 * (*steps % 48) as f32 - 1.2,
                1.5,
                8.0 + 0.03 * (*steps % 56) as f32,
            ),
            Mesh3d(look.0.clone()),
            MeshMaterial3d(look.1[mode].clone()),
        ));
        match mode {
            0 => cube.insert(SpeculativeMargin::ZERO),
            1 => &mut cube,
            _ => cube.insert((SpeculativeMargin::ZERO, SweptCcd::NON_LINEAR)),
        };
    }
}

/// Removes cubes after two seconds, and counts those that are behind their plate.
fn remove_old(
    mut commands: Commands,
    mut cubes: Query<(Entity, &mut Bullet, &Position)>,
    mut counts: Local<[(u32, u32); 3]>,
    mut readout: Single<&mut Text, With<Readout>>,
) {
    for (cube, mut bullet, at) in &mut cubes {
        bullet.steps += 1;
        if bullet.steps == 128 {
            let (passed, all) = &mut counts[bullet.mode];
            *passed += u32::from(at.z < -0.5);
            *all += 1;
            commands.entity(cube).despawn();
        }
    }
    let line = |((name, _), (passed, all))| format!("{name}: {passed} of {all} passed");
    readout.0 = MODES.into_iter().zip(*counts).map(line).collect::<Vec<_>>().join("\n");
}

/// A line along the way of a tick.
fn draw_trails(cubes: Query<(&Position, &LinearVelocity), With<Bullet>>, mut gizmos: Gizmos) {
    for (at, velocity) in cubes.iter().filter(|(_, velocity)| velocity.length() > 10.0) {
        gizmos.line(at.0 - velocity.0 / 64.0, at.0, Color::srgb(1.0, 0.8, 0.4));
    }
}

fn change_speed(keys: Res<ButtonInput<KeyCode>>, mut speed: ResMut<Speed>) {
    if keys.just_pressed(KeyCode::Space) {
        speed.0 = if speed.0 < 400.0 { 2.0 * speed.0 } else { 25.0 };
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let grey = materials.add(Color::srgb(0.35, 0.4, 0.45));
    let mut fixed = |size: Vec3, place: Vec3, body: RigidBody| {
        let mesh = Mesh3d(meshes.add(Cuboid::from_size(size)));
        let collider = Collider::cuboid(size.x, size.y, size.z);
        (body, collider, Transform::from_translation(place), mesh, MeshMaterial3d(grey.clone()))
    };
    commands.spawn(fixed(Vec3::new(14.0, 4.0, 0.01), Vec3::new(0.0, 2.0, -5.0), RigidBody::Static));
    for (mode, (_, x)) in MODES.into_iter().enumerate() {
        let plate = fixed(Vec3::new(3.0, 3.0, 0.01), Vec3::new(x, 1.6, 0.0), RigidBody::Kinematic);
        let mut plate = commands.spawn((plate, AngularVelocity(Vec3::Z * 2.0)));
        if mode != 1 {
            plate.insert(SpeculativeMargin::ZERO);
        }
    }
    let colors = [0.0, 120.0, 240.0].map(|hue| materials.add(Color::hsl(hue, 0.5, 0.6)));
    commands.insert_resource(Look(meshes.add(Cuboid::from_length(SIDE)), colors));
}
