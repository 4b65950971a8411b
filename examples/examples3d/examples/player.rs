//! A dynamic player that walks and jumps. Look at the ramps: the player stands still on the gentle one, slides down the steep one, and
//! the platform takes it along. It pushes boxes and stands on them. Arrow keys or WASD walk, space jumps.
//!
//! `cargo run --release -p examples3d --example player`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
The player stands still on gentle ramps, slides down steep ones, pushes boxes and rides the platform.
Arrow keys or WASD: walk. Space: jump.";

/// Radius of the player's capsule, and length between its caps, in metres.
const SIZE: (f32, f32) = (0.4, 0.8);
/// Speed of walking and of a jump, in m/s.
const SPEED: (f32, f32) = (5.0, 6.0);
/// Acceleration by the feet and in the air, in m/s².
const ACCELERATION: (f32, f32) = (50.0, 15.0);
/// Ground of up to 45° can be stood on: the least upward part of its normal.
const LEAST_UP: f32 = 0.7;
/// A jump counts so long after the key, and so long after the ground, in seconds.
const GRACE: f32 = 0.1;

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    let scenery =
        Scenery::new(Vec3::new(0.0, 8.0, 13.0), Vec3::new(0.0, 1.0, 0.0)).with_floor().with_hint(HINT);
    app.add_plugins((PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .add_systems(Update, read_keys)
        .add_systems(FixedUpdate, (swing, walk));
}

/// What the keys ask for, and how long ago the feet were on the ground, in seconds.
#[derive(Component, Default)]
pub(crate) struct Player {
    direction: Vec3,
    since_key: f32,
    since_ground: f32,
}

#[derive(Component)]
pub(crate) struct Platform;

fn read_keys(keys: Res<ButtonInput<KeyCode>>, mut player: Single<&mut Player>) {
    let pressed = |arrow, letter| f32::from(keys.any_pressed([arrow, letter]));
    let x = pressed(KeyCode::ArrowRight, KeyCode::KeyD) - pressed(KeyCode::ArrowLeft, KeyCode::KeyA);
    let z = pressed(KeyCode::ArrowDown, KeyCode::KeyS) - pressed(KeyCode::ArrowUp, KeyCode::KeyW);
    player.direction = Vec3::new(x, 0.0, z).normalize_or_zero();
    if keys.just_pressed(KeyCode::Space) {
        player.since_key = 0.0;
    }
}

fn walk(
    queries: SpatialQuery,
    grounds: Query<&LinearVelocity, Without<Player>>,
    mut players: Query<(Entity, &mut Player, Forces)>,
    gravity: Res<Gravity>,
    time: Res<Time>,
) {
    let dt = time.delta_secs();
    for (entity, mut player, mut body) in &mut players {
        // The foot is a little thinner than the capsule, so that walls are no ground.
        let (radius, length) = SIZE;
        let origin = body.position().0 - Vec3::Y * 0.5 * length;
        let reach = ShapeCastConfig::from_max_distance(0.25 * radius);
        let filter = SpatialQueryFilter::from_excluded_entities([entity]);
        let foot = Collider::sphere(0.9 * radius);
        let hit = queries.cast_shape(&foot, origin, Quat::IDENTITY, Dir3::NEG_Y, &reach, &filter);
        let ground = hit.filter(|hit| hit.normal1.y > LEAST_UP).map(|hit| {
            let velocity = grounds.get(hit.entity).map_or(Vec3::ZERO, |velocity| velocity.0);
            (hit.normal1, velocity)
        });
        // A player that leaves the ground, by a jump, does not stand on it.
        let velocity = body.linear_velocity();
        let ground = ground.filter(|(normal, ground)| (velocity - ground).dot(*normal) < 1.0);

        player.since_ground = if ground.is_some() { 0.0 } else { player.since_ground + dt };
        let (normal, base) = ground.unwrap_or((Vec3::Y, Vec3::ZERO));
        let most = if ground.is_some() { ACCELERATION.0 } else { ACCELERATION.1 };
        // The way on the ground that is the direction of the keys from above.
        let way = (player.direction - normal * (player.direction.dot(normal))).normalize_or_zero();
        let acceleration = (base + way * SPEED.0 - velocity).reject_from(normal) / dt;
        // In the air without a key the player flies on.
        if ground.is_some() || player.direction != Vec3::ZERO {
            body.apply_linear_acceleration(acceleration.clamp_length_max(most));
        }
        if ground.is_some() {
            // The feet hold against the part of gravity along the slope.
            body.apply_linear_acceleration(-gravity.0.reject_from(normal));
        }
        if player.since_key < GRACE && player.since_ground < GRACE {
            body.linear_velocity_mut().y = base.y + SPEED.1;
            (player.since_key, player.since_ground) = (GRACE, GRACE);
        }
        player.since_key += dt;
    }
}

/// The platform eases to and fro: 4 m each way.
fn swing(time: Res<Time>, mut velocity: Single<&mut LinearVelocity, With<Platform>>) {
    velocity.x = 2.0 * (0.5 * time.elapsed_secs()).sin();
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let (radius, length) = SIZE;
    commands.spawn((
        Player { since_key: GRACE, ..default() },
        RigidBody::Dynamic,
        Collider::capsule(radius, length),
        LockedAxes::ROTATION_LOCKED,
        // The feet do what friction does, so that walls do not hold the player.
        Friction::ZERO.with_combine_rule(CoefficientCombine::Min),
        TransformInterpolation,
        Transform::from_xyz(0.0, 1.0, 3.0),
        Mesh3d(meshes.add(Capsule3d::new(radius, length))),
        MeshMaterial3d(materials.add(Color::srgb(0.9, 0.5, 0.3))),
    ));
    let mut block = |body: RigidBody, size: Vec3, place: Vec3, angle: f32, color: Color| {
        let block = commands.spawn((
            body,
            Collider::cuboid(size.x, size.y, size.z),
            Transform::from_translation(place).with_rotation(Quat::from_rotation_z(angle)),
            Mesh3d(meshes.add(Cuboid::from_size(size))),
            MeshMaterial3d(materials.add(color)),
        ));
        block.id()
    };
    let (stone, amber) = (Color::srgb(0.5, 0.55, 0.6), Color::srgb(0.9, 0.7, 0.3));
    // A gentle ramp on the left, a steep one on the right.
    block(RigidBody::Static, Vec3::new(6.0, 0.6, 3.0), Vec3::new(-8.3, 0.35, 0.0), 0.5, stone);
    block(RigidBody::Static, Vec3::new(6.0, 0.6, 3.0), Vec3::new(8.5, 2.2, 0.0), 1.05, stone);
    for i in 0..6 {
        let place = Vec3::new(2.0 + 1.2 * (i % 3) as f32, 0.45, 3.0 + 1.2 * (i / 3) as f32);
        block(RigidBody::Dynamic, Vec3::splat(0.9), place, 0.0, amber);
    }
    let platform =
        block(RigidBody::Kinematic, Vec3::new(3.0, 0.3, 3.0), Vec3::new(-4.0, 1.9, 0.0), 0.0, stone);
    commands.entity(platform).insert(Platform);
}
