//! Blows: how often, how fast, how hard.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;

#[derive(Resource, Default)]
struct Seen {
    messages: Vec<CollisionHit>,
    observed: Vec<CollisionHit>,
}

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.insert_resource(Gravity(Vector::NEG_Y * 10.0)).init_resource::<Seen>();
    app.add_systems(PostUpdate, |mut hits: MessageReader<CollisionHit>, mut seen: ResMut<Seen>| {
        seen.messages.extend(hits.read());
    });
    app.add_observer(|hit: On<CollisionHit>, mut seen: ResMut<Seen>| seen.observed.push(*hit));
    app
}

fn steps(app: &mut App, count: u32) {
    for _ in 0..count {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / 64.0));
        app.update();
    }
}

fn cube(half: Scalar) -> Collider {
    let mut corners = vec![Vector::ZERO];
    for axis in Vector::AXES {
        corners = corners.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

fn spawn_floor(app: &mut App) -> Entity {
    app.world_mut().spawn((RigidBody::Static, cube(20.0), Transform::from_xyz(0.0, -20.0, 0.0))).id()
}

/// A box of 2 kg that falls flat from `height` above the floor.
fn spawn_falling(app: &mut App, height: f32) -> Entity {
    app.world_mut()
        .spawn((
            RigidBody::Dynamic,
            cube(0.5),
            Mass(2.0),
            CollisionHitsEnabled::default(),
            Transform::from_xyz(0.0, 0.5 + height, 0.0),
        ))
        .id()
}

#[test]
fn a_box_that_falls_reports_one_blow_with_its_speed_and_momentum() {
    let mut app = app();
    let floor = spawn_floor(&mut app);
    let falling = spawn_falling(&mut app, 2.0);
    steps(&mut app, 200);
    let seen = app.world().resource::<Seen>();
    assert_eq!((seen.messages.len(), seen.observed.len()), (1, 1), "{:?}", seen.messages);
    let hit = seen.observed[0];
    assert_eq!((hit.collider1, hit.collider2, hit.body1), (falling, floor, Some(falling)));
    let speed = (2.0 * 10.0 * 2.0 as Scalar).sqrt();
    assert!((hit.speed - speed).abs() < 0.4, "{hit:?} for {speed} m/s");
    assert!((hit.impulse - 2.0 * hit.speed).abs() < 0.05 * hit.impulse, "{hit:?}");
    assert!((hit.normal + Vector::Y).length() < 1.0e-3, "{hit:?}");
    assert!(hit.point.length() < 0.1, "{hit:?}");
}

#[test]
fn restitution_makes_blows_harder_and_each_bounce_is_one() {
    let mut app = app();
    spawn_floor(&mut app);
    let falling = spawn_falling(&mut app, 2.0);
    app.world_mut().entity_mut(falling).insert((
        Restitution::new(1.0).with_combine_rule(CoefficientCombine::Max),
        LockedAxes::ROTATION_LOCKED,
    ));
    steps(&mut app, 64);
    let hits = &app.world().resource::<Seen>().messages;
    assert_eq!(hits.len(), 1, "{hits:?}");
    assert!((hits[0].impulse - 4.0 * hits[0].speed).abs() < 0.05 * hits[0].impulse, "{:?}", hits[0]);
    steps(&mut app, 64 * 3);
    let hits = &app.world().resource::<Seen>().messages;
    // It falls and rises in 1.26 s.
    assert!((3..=4).contains(&hits.len()), "{hits:?}");
}

#[test]
fn two_bodies_share_the_impulse_by_their_masses() {
    let mut app = app();
    app.insert_resource(Gravity(Vector::ZERO));
    let mut spawn = |x: f32, speed: Scalar, mass| {
        app.world_mut()
            .spawn((
                RigidBody::Dynamic,
                cube(0.5),
                Mass(mass),
                LinearVelocity(Vector::X * speed),
                Transform::from_xyz(x, 0.0, 0.0),
            ))
            .id()
    };
    let (left, right) = (spawn(-2.0, 3.0, 1.0), spawn(2.0, -2.0, 3.0));
    app.world_mut().entity_mut(right).insert(CollisionHitsEnabled::above(4.0));
    steps(&mut app, 64);
    let seen = app.world().resource::<Seen>();
    assert_eq!(seen.observed.len(), 1, "only the right one reports");
    let hit = seen.observed[0];
    assert_eq!((hit.collider1, hit.collider2), (right, left));
    assert!((hit.speed - 5.0).abs() < 1.0e-3, "{hit:?}");
    assert!((hit.impulse - 5.0 * 0.75).abs() < 0.05, "{hit:?}");
    let velocity = app.world().get::<LinearVelocity>(left).unwrap().x;
    assert!((3.0 - velocity - hit.impulse).abs() < 0.05, "{velocity} m/s after {hit:?}");
}

#[test]
fn slow_blows_sensors_and_what_does_not_ask_report_nothing() {
    let mut app = app();
    spawn_floor(&mut app);
    let slow = spawn_falling(&mut app, 0.02);
    let deaf = spawn_falling(&mut app, 3.0);
    app.world_mut()
        .entity_mut(deaf)
        .remove::<CollisionHitsEnabled>()
        .insert(Transform::from_xyz(5.0, 3.0, 0.0));
    let high = spawn_falling(&mut app, 3.0);
    app.world_mut()
        .entity_mut(high)
        .insert((CollisionHitsEnabled::above(Scalar::NAN), Transform::from_xyz(-5.0, 3.0, 0.0)));
    let sensor = spawn_falling(&mut app, 3.0);
    app.world_mut().entity_mut(sensor).insert((Sensor, Transform::from_xyz(9.0, 3.0, 0.0)));
    steps(&mut app, 100);
    let seen = app.world().resource::<Seen>();
    assert!(seen.messages.is_empty() && seen.observed.is_empty(), "{:?}", seen.messages);
    // After `CollisionHitsEnabled` is inserted, the next blow is reported.
    app.world_mut().entity_mut(slow).insert(LinearVelocity(Vector::Y * 5.0));
    app.world_mut()
        .entity_mut(deaf)
        .insert((CollisionHitsEnabled::default(), LinearVelocity(Vector::Y * 5.0)));
    steps(&mut app, 100);
    let colliders: Vec<Entity> =
        app.world().resource::<Seen>().observed.iter().map(|hit| hit.collider1).collect();
    assert!(colliders.len() == 2 && colliders.contains(&slow) && colliders.contains(&deaf));
}

#[test]
fn an_observer_may_despawn_what_was_hit() {
    let mut app = app();
    spawn_floor(&mut app);
    for i in 0..5 {
        let body = spawn_falling(&mut app, 1.0);
        app.world_mut().entity_mut(body).insert(Transform::from_xyz(2.0 * i as f32, 2.0, 0.0));
    }
    app.add_observer(|hit: On<CollisionHit>, mut commands: Commands| {
        commands.entity(hit.collider1).try_despawn();
        commands.entity(hit.collider2).try_despawn();
    });
    steps(&mut app, 100);
    assert!(!app.world().resource::<Seen>().messages.is_empty());
}

/// A hull of random corners that falls without turning onto a floor of tiles. Each first blow has the speed
/// of the fall, and each pair reports a blow once.
#[test]
fn issue_a_hull_that_struck_tiles_was_told_of_blows_with_other_speeds() {
    let mut seed = 1_u32;
    let mut random = move || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32
    };
    let mut wrong = Vec::new();
    for case in 0..40 {
        let mut app = app();
        let size = 0.5 + 0.5 * random() as Scalar;
        for x in -4..=4_i8 {
            for z in -2..=2_i8 {
                if Vector::AXES.len() == 2 && z != 0 {
                    continue;
                }
                let center = Transform::from_xyz(f32::from(x), -0.5, f32::from(z));
                app.world_mut().spawn((RigidBody::Static, cube(0.5), center));
            }
        }
        let corners: Vec<Vector> = (0..12)
            .map(|_| {
                let corner = Vector::AXES
                    .iter()
                    .fold(Vector::ZERO, |sum, axis| sum + *axis * (random() as Scalar - 0.5));
                corner.normalize_or_zero() * size
            })
            .collect();
        let hull = Collider::convex_hull(corners).expect("corners around the origin");
        let height = 1.5 + 2.0 * random();
        let place = Transform::from_xyz(random() - 0.5, height, random() - 0.5);
        let body = (RigidBody::Dynamic, hull, place, CollisionHitsEnabled::above(0.5));
        let body = app.world_mut().spawn(body).id();
        let mut speed = 0.0;
        for _ in 0..200 {
            if app.world().resource::<Seen>().messages.is_empty() {
                speed = -app.world().get::<LinearVelocity>(body).expect("a body").y;
            }
            steps(&mut app, 1);
        }
        let hits = &app.world().resource::<Seen>().messages;
        assert!(!hits.is_empty(), "case {case}: it fell");
        if (hits[0].speed - speed).abs() > 0.2 {
            wrong.push((case, hits[0].speed, speed));
        }
    }
    assert_eq!(wrong, [], "case, reported and true speed");
}
