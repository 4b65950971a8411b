//! A dynamic player that walks and jumps. Look at the slopes: the player stands still on the gentle one and slides down the
//! steep one, and the platform takes it along. Left and right or A and D walk, space jumps.
//!
//! `cargo run --release -p examples2d --example player`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "\
The player stands still on gentle slopes, slides down steep ones, pushes boxes and rides the platform.
Left, Right or A, D: walk. Space: jump.";

/// Radius of the player's capsule, and length between its caps, in metres.
const SIZE: (f32, f32) = (0.4, 0.8);
/// Speed of walking and of a jump, in m/s.
const SPEED: (f32, f32) = (5.0, 7.5);
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
    app.add_plugins((PhysicsPlugins::default(), Scenery::with_floor().with_hint(HINT)))
        .add_systems(Startup, setup)
        .add_systems(Update, read_keys)
        .add_systems(FixedUpdate, (swing, walk));
}

/// What the keys ask for, and how long ago the feet were on the ground, in seconds.
#[derive(Component, Default)]
pub(crate) struct Player {
    direction: f32,
    since_key: f32,
    since_ground: f32,
}

#[derive(Component)]
pub(crate) struct Platform;

fn read_keys(keys: Res<ButtonInput<KeyCode>>, mut player: Single<&mut Player>) {
    let right = f32::from(keys.any_pressed([KeyCode::ArrowRight, KeyCode::KeyD]));
    let left = f32::from(keys.any_pressed([KeyCode::ArrowLeft, KeyCode::KeyA]));
    player.direction = right - left;
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
        let origin = body.position().0 - Vec2::Y * 0.5 * length;
        let reach = ShapeCastConfig::from_max_distance(0.25 * radius);
        let filter = SpatialQueryFilter::from_excluded_entities([entity]);
        let foot = Collider::circle(0.9 * radius);
        let hit = queries.cast_shape(&foot, origin, 0.0, Dir2::NEG_Y, &reach, &filter);
        let ground = hit.filter(|hit| hit.normal1.y > LEAST_UP).map(|hit| {
            let velocity = grounds.get(hit.entity).map_or(Vec2::ZERO, |velocity| velocity.0);
            (hit.normal1, velocity)
        });
        // A player that leaves the ground, by a jump, does not stand on it.
        let velocity = body.linear_velocity();
        let ground = ground.filter(|(normal, ground)| (velocity - ground).dot(*normal) < 1.0);

        player.since_ground = if ground.is_some() { 0.0 } else { player.since_ground + dt };
        let (normal, base) = ground.unwrap_or((Vec2::Y, Vec2::ZERO));
        let along = Vec2::new(normal.y, -normal.x);
        let most = if ground.is_some() { ACCELERATION.0 } else { ACCELERATION.1 };
        let wanted = base.dot(along) + SPEED.0 * player.direction;
        let acceleration = ((wanted - velocity.dot(along)) / dt).clamp(-most, most);
        // In the air without a key the player flies on.
        if ground.is_some() || player.direction != 0.0 {
            body.apply_linear_acceleration(along * acceleration);
        }
        if ground.is_some() {
            // The feet hold against the part of gravity along the slope.
            body.apply_linear_acceleration(-along * gravity.0.dot(along));
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
    mut materials: ResMut<Assets<ColorMaterial>>,
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
        Transform::from_xyz(-3.0, 1.0, 0.0),
        Mesh2d(meshes.add(Capsule2d::new(radius, length))),
        MeshMaterial2d(materials.add(Color::srgb(0.9, 0.5, 0.3))),
    ));
    let mut block = |body: RigidBody, size: Vec2, place: Vec2, angle: f32, color: Color| {
        let block = commands.spawn((
            body,
            Collider::rectangle(size.x, size.y),
            Transform::from_translation(place.extend(0.0)).with_rotation(Quat::from_rotation_z(angle)),
            Mesh2d(meshes.add(Rectangle::from_size(size))),
            MeshMaterial2d(materials.add(color)),
        ));
        block.id()
    };
    let (grey, amber) = (Color::srgb(0.35, 0.4, 0.45), Color::srgb(0.9, 0.7, 0.3));
    // A gentle slope on the left, a steep one on the right.
    block(RigidBody::Static, Vec2::new(8.0, 1.0), Vec2::new(-8.2, 0.6), -0.5, grey);
    block(RigidBody::Static, Vec2::new(8.0, 1.0), Vec2::new(10.6, 2.0), 1.05, grey);
    for place in [Vec2::new(6.2, 0.45), Vec2::new(7.4, 0.45), Vec2::new(6.2, 1.35)] {
        block(RigidBody::Dynamic, Vec2::splat(0.9), place, 0.0, amber);
    }
    let platform = block(RigidBody::Kinematic, Vec2::new(3.0, 0.4), Vec2::new(-4.0, 2.0), 0.0, grey);
    commands.entity(platform).insert(Platform);
}
