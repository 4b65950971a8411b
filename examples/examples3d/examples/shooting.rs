//! Balls shot from the camera at a wall. Look at the flashes: `CollisionHit` tells where a ball strikes and how hard, and a flash is
//! as large as the blow. Click to shoot where the pointer is.
//!
//! `cargo run --release -p examples3d --example shooting`

use avian3d::prelude::*;
use bevy::{input::common_conditions::input_just_pressed, prelude::*};
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
A flash shows where a ball strikes. The harder the blow, the larger the flash.
Click: shoot a ball.";

/// Radius of a ball in metres.
const RADIUS: f32 = 0.25;
/// Speed of a ball in m/s.
const SPEED: f32 = 30.0;
/// Lifetimes of a ball and of a flash, in seconds.
const LIFE: (f32, f32) = (10.0, 0.4);

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    let scenery =
        Scenery::new(Vec3::new(0.0, 3.0, 13.0), Vec3::new(0.0, 2.0, 0.0)).with_floor().with_hint(HINT);
    app.add_plugins((PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .add_systems(Update, (shoot.run_if(input_just_pressed(MouseButton::Left)), fade))
        .add_observer(flash);
}

#[derive(Resource)]
pub(crate) struct Looks {
    sphere: Handle<Mesh>,
    iron: Handle<StandardMaterial>,
    light: Handle<StandardMaterial>,
}

/// What is taken away after some seconds.
#[derive(Component)]
pub(crate) struct Life {
    left: f32,
    shrinks: bool,
}

fn shoot(window: Single<&Window>, camera: Single<(&Camera, &GlobalTransform)>, mut commands: Commands) {
    let (camera, pose) = *camera;
    let ray = window.cursor_position().and_then(|cursor| camera.viewport_to_world(pose, cursor).ok());
    if let Some(ray) = ray {
        commands.run_system_cached_with(shoot_along, ray);
    }
}

/// The ball starts a metre in front of the camera.
pub(crate) fn shoot_along(ray: In<Ray3d>, looks: Res<Looks>, mut commands: Commands) {
    commands.spawn((
        Life { left: LIFE.0, shrinks: false },
        RigidBody::Dynamic,
        Collider::sphere(RADIUS),
        ColliderDensity(8.0),
        LinearVelocity(*ray.direction * SPEED),
        // Blows of 2 m/s and more are told.
        CollisionHitsEnabled::above(2.0),
        Transform::from_translation(ray.get_point(1.0)),
        Mesh3d(looks.sphere.clone()),
        MeshMaterial3d(looks.iron.clone()),
    ));
}

/// Runs for every blow of a ball.
fn flash(hit: On<CollisionHit>, looks: Res<Looks>, mut commands: Commands) {
    // A blow of 10 N·s looks as large as a ball.
    let size = (hit.impulse / 10.0).sqrt();
    commands.spawn((
        Life { left: LIFE.1, shrinks: true },
        Transform::from_translation(hit.point).with_scale(Vec3::splat(size)),
        Mesh3d(looks.sphere.clone()),
        MeshMaterial3d(looks.light.clone()),
    ));
}

fn fade(mut commands: Commands, mut lives: Query<(Entity, &mut Life, &mut Transform)>, time: Res<Time>) {
    for (entity, mut life, mut transform) in &mut lives {
        let before = life.left;
        life.left -= time.delta_secs();
        if life.left <= 0.0 {
            commands.entity(entity).despawn();
        } else if life.shrinks {
            transform.scale *= life.left / before;
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.insert_resource(Looks {
        sphere: meshes.add(Sphere::new(RADIUS)),
        iron: materials.add(Color::srgb(0.3, 0.3, 0.35)),
        light: materials.add(StandardMaterial {
            base_color: Color::srgb(1.0, 0.9, 0.5),
            unlit: true,
            ..default()
        }),
    });
    let size = Vec3::new(1.0, 0.5, 0.5);
    let brick = meshes.add(Cuboid::from_size(size));
    let shades = [0.0, 0.08].map(|light| materials.add(Color::srgb(0.65 + light, 0.35 + light, 0.25)));
    for (column, row) in (0..80).map(|i| (i % 8, i / 8)) {
        let shift = 0.5 * (row % 2) as f32;
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(size.x, size.y, size.z),
            Transform::from_xyz(column as f32 - 3.75 + shift, 0.25 + 0.5 * row as f32, 0.0),
            Mesh3d(brick.clone()),
            MeshMaterial3d(shades[(column + row) % 2].clone()),
        ));
    }
}
