//! Continuous collision, three modes side by side. Look at the cubes that are shot at a thin turning plate: without prediction and
//! sweep many fly through. Behind is a static wall of 1 cm, which nothing passes in any mode. Space changes the speed.
//!
//! `cargo run --release -p examples3d --example ccd`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    let scenery = Scenery::new(Vec3::new(7.0, 6.0, 13.0), Vec3::new(0.0, 0.5, -1.0)).with_floor();
    app.add_plugins((PhysicsPlugins::default(), scenery))
        .insert_resource(Speed(100.0))
        .add_systems(Startup, setup)
        .add_systems(Update, change_speed)
        .add_systems(FixedUpdate, (shoot, remove_fallen));
}

/// Of new cubes, in m/s.
#[derive(Resource)]
struct Speed(f32);

#[derive(Component)]
pub(crate) struct Bullet;

#[derive(Resource)]
struct Look(Handle<Mesh>, [Handle<StandardMaterial>; 3]);

/// The place of each mode: neither, prediction (the default), sweep alone.
const PLACES: [f32; 3] = [-4.0, 0.0, 4.0];

fn shoot(mut commands: Commands, look: Res<Look>, speed: Res<Speed>, mut steps: Local<u32>) {
    *steps += 1;
    if !steps.is_multiple_of(8) {
        return;
    }
    for (mode, x) in PLACES.into_iter().enumerate() {
        let mut cube = commands.spawn((
            Bullet,
            RigidBody::Dynamic,
            Collider::cuboid(0.1, 0.1, 0.1),
            LinearVelocity(Vec3::new(0.0, 1.0, -speed.0)),
            AngularVelocity(Vec3::new(9.0, -7.0, 5.0)),
            Transform::from_xyz(x + 0.05 * (*steps % 48) as f32 - 1.2, 1.5, 8.0),
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

fn remove_fallen(mut commands: Commands, cubes: Query<(Entity, &Position), With<Bullet>>) {
    cubes.iter().filter(|(_, at)| at.y < -10.0).for_each(|(cube, _)| commands.entity(cube).despawn());
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
    for (mode, x) in PLACES.into_iter().enumerate() {
        let plate = fixed(Vec3::new(3.0, 3.0, 0.01), Vec3::new(x, 1.6, 0.0), RigidBody::Kinematic);
        let mut plate = commands.spawn((plate, AngularVelocity(Vec3::Z * 2.0)));
        if mode != 1 {
            plate.insert(SpeculativeMargin::ZERO);
        }
    }
    let colors = [0.0, 120.0, 240.0].map(|hue| materials.add(Color::hsl(hue, 0.5, 0.6)));
    commands.insert_resource(Look(meshes.add(Cuboid::from_length(0.1)), colors));
}
