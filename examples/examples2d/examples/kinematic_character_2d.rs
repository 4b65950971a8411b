//! A character of one's own on `MoveAndSlide`: gravity, jumps and a slope, in fifty lines. `character` shows what the engine has
//! ready. A, D or arrows walk, Space jumps. Look at how it stands on the slope, and at how it runs into the wall.
//!
//! `cargo run --release -p examples2d --example kinematic_character_2d`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "Walk: A, D or arrows. Jump: space.\n\
    Stand on the slope, jump at the wall, walk into the corner.";

/// In m/s.
const SPEED: f32 = 4.0;
const JUMP: f32 = 6.0;
/// In m/s².
const GRAVITY: f32 = 9.81;
/// Acceleration of the character in the air, in m/s².
const AIR: f32 = 10.0;
/// The least upward part of the normal of a floor: 50 degrees.
const FLOOR: f32 = 0.64;

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    let scenery = Scenery::with_floor().with_hint(HINT);
    app.add_plugins((PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .add_systems(Update, listen)
        .add_systems(FixedUpdate, walk);
}

/// What the player wants, and how the character moves.
#[derive(Component, Default)]
pub(crate) struct Walker {
    wish: Vec2,
    jumps: bool,
    pub(crate) velocity: Vec2,
    /// The normal of the floor that it stands on.
    pub(crate) floor: Option<Vec2>,
}

fn listen(keys: Res<ButtonInput<KeyCode>>, mut walkers: Query<&mut Walker>) {
    let held = |pair: [KeyCode; 2]| f32::from(keys.any_pressed(pair));
    let x = held([KeyCode::KeyD, KeyCode::ArrowRight]) - held([KeyCode::KeyA, KeyCode::ArrowLeft]);
    for mut walker in &mut walkers {
        walker.wish = Vec2::new(x, 0.0).clamp_length_max(1.0) * SPEED;
        walker.jumps |= keys.just_pressed(KeyCode::Space);
    }
}

fn walk(
    mut walkers: Query<(Entity, &mut Walker, &Collider, &mut Transform)>,
    mover: MoveAndSlide,
    time: Res<Time>,
) {
    for (entity, mut walker, shape, mut transform) in &mut walkers {
        let wanted = match walker.floor {
            Some(_) if walker.jumps => walker.wish + Vec2::Y * JUMP,
            // Along the floor at the horizontal speed that is wanted, and lightly onto it.
            Some(normal) => walker.wish - Vec2::Y * (normal.dot(walker.wish) / normal.y) - normal * 0.1,
            None => {
                let across = Vec2::new(walker.velocity.x, 0.0);
                let across = across.move_towards(walker.wish, AIR * time.delta_secs());
                across + Vec2::Y * (walker.velocity.y - GRAVITY * time.delta_secs())
            }
        };
        let mut floor: Option<Vec2> = None;
        let moved = mover.move_and_slide(
            shape,
            transform.translation.xy(),
            transform.rotation.to_euler(EulerRot::XYZ).2,
            wanted,
            time.delta(),
            &MoveAndSlideConfig::default(),
            &SpatialQueryFilter::from_excluded_entities([entity]),
            |hit| {
                let normal: Vec2 = (*hit.normal).into();
                if normal.y > FLOOR && floor.is_none_or(|floor| normal.y > floor.y) {
                    floor = Some(normal);
                }
                MoveAndSlideHitResponse::Accept
            },
        );
        transform.translation = moved.position.extend(0.0);
        *walker = Walker { wish: walker.wish, jumps: false, velocity: moved.projected_velocity, floor };
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let [grey, blue] = [[0.5, 0.55, 0.6], [0.3, 0.5, 0.8]].map(|c| materials.add(Color::srgb_from_array(c)));
    commands.spawn((
        Walker::default(),
        RigidBody::Kinematic,
        Collider::capsule(0.4, 1.0),
        Transform::from_xyz(0.0, 2.0, 0.0),
        TransformInterpolation,
        Mesh2d(meshes.add(Capsule2d::new(0.4, 1.0))),
        MeshMaterial2d(blue),
    ));
    let mut block = |size: Vec2, place: Transform| {
        (
            Collider::rectangle(size.x, size.y),
            place,
            Mesh2d(meshes.add(Rectangle::from_size(size))),
            MeshMaterial2d(grey.clone()),
        )
    };
    let slope = Transform::from_xyz(4.0, 0.9, 0.0).with_rotation(Quat::from_rotation_z(0.5));
    commands.spawn((RigidBody::Static, block(Vec2::new(5.0, 0.4), slope)));
    let steep = Transform::from_xyz(-4.5, 1.2, 0.0).with_rotation(Quat::from_rotation_z(-1.1));
    commands.spawn((RigidBody::Static, block(Vec2::new(4.0, 0.4), steep)));
    for (size, place) in [
        (Vec2::new(1.0, 6.0), Vec3::new(9.0, 3.0, 0.0)),
        (Vec2::new(1.0, 6.0), Vec3::new(-9.0, 3.0, 0.0)),
        (Vec2::new(2.0, 0.3), Vec3::new(0.0, 3.0, 0.0)),
    ] {
        commands.spawn((RigidBody::Static, block(size, Transform::from_translation(place))));
    }
}
