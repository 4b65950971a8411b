//! Changes by the app at the worst moment: in mid-contact, asleep, from inside the engine's own observers.

use avian::{math::Vector, prelude::*};
use bevy_ecs::{entity_disabling::Disabled, prelude::*};
use bevy_transform::components::Transform;

use super::world::{Witness, app, at, ball, corners, floor, is_witness, position, resting, steps};

#[test]
fn ten_thousand_colliders_on_one_body_come_and_go() {
    let mut witness = Witness::new();
    let body = witness.spawn((RigidBody::Dynamic, at(0.0, 1.0)));
    for i in 0..10_000 {
        let place = at(0.3 * (i % 100) as f32, 0.3 * (i / 100) as f32);
        witness.spawn((ball(), place, ChildOf(body)));
    }
    steps(&mut witness.app, 50);
    assert!((position(&witness.app, body).y - 0.5).abs() < 0.05);
    witness.insert(body, RigidBody::Static);
    steps(&mut witness.app, 2);
    witness.app.world_mut().despawn(body);
    witness.is_undisturbed();
}

/// Removes the support in contact, in one of several ways.
type Change = fn(&mut EntityWorldMut);

const CHANGES: [(&str, Change); 12] = [
    ("disables its body", |e| _ = e.insert(RigidBodyDisabled)),
    ("disables its collider", |e| _ = e.insert(ColliderDisabled)),
    ("disables it", |e| _ = e.insert(Disabled)),
    ("makes it dynamic", |e| _ = e.insert(RigidBody::Dynamic)),
    ("makes it kinematic", |e| _ = e.insert(RigidBody::Kinematic)),
    ("removes its body", |e| _ = e.remove::<RigidBody>()),
    ("removes its collider", |e| _ = e.remove::<Collider>()),
    ("makes it a sensor", |e| _ = e.insert(Sensor)),
    ("gives it other layers", |e| _ = e.insert(CollisionLayers::NONE)),
    ("moves it", |e| _ = e.insert(Position(Vector::X * 50.0))),
    ("moves its transform", |e| _ = e.insert(Transform::from_xyz(50.0, 0.0, 0.0))),
    ("gives it another shape", |e| _ = e.insert(Collider::capsule(0.1, 0.1))),
];

/// The support of a sleeping ball is removed, changed or moved: the ball must fall.
#[test]
fn whatever_happens_to_its_support_a_sleeping_body_falls() {
    for (name, change) in CHANGES {
        let mut app = app();
        let block = Collider::convex_hull(corners(1.0)).expect("a box is convex");
        let support = app.world_mut().spawn((RigidBody::Static, block, at(0.0, 0.0))).id();
        let ball = app.world_mut().spawn((RigidBody::Dynamic, ball(), at(0.0, 1.5))).id();
        steps(&mut app, 120);
        assert!(app.world().get::<Sleeping>(ball).is_some(), "{name}: it sleeps first");
        let before = position(&app, ball).y;
        change(&mut app.world_mut().entity_mut(support));
        steps(&mut app, 120);
        let fell = before - position(&app, ball).y;
        assert_eq!(fell > 0.5, name != "makes it kinematic", "{name}: it fell by {fell}");
    }
    let mut app = app();
    let support = floor(&mut app);
    let ball = resting(&mut app, 0.0);
    steps(&mut app, 120);
    app.world_mut().despawn(support);
    steps(&mut app, 60);
    assert!(position(&app, ball).y < -1.0);
}

/// The same by observers of sleep, on the body that falls asleep or wakes.
#[test]
fn observers_of_sleep_may_do_anything_to_the_sleeper() {
    for (_, change) in CHANGES.into_iter().chain([("", despawn as Change)]) {
        let mut witness = Witness::new();
        for i in 0..6 {
            resting(&mut witness.app, 0.99 * i as f32);
        }
        let meddle = move |entity: Entity, mut commands: Commands| {
            commands.queue(move |world: &mut World| {
                if let Ok(mut entity) = world.get_entity_mut(entity)
                    && !entity.get::<Position>().is_some_and(is_witness)
                {
                    change(&mut entity);
                }
            });
        };
        witness
            .app
            .add_observer(move |on: On<Add, Sleeping>, commands: Commands| meddle(on.entity, commands));
        witness
            .app
            .add_observer(move |on: On<Remove, Sleeping>, commands: Commands| meddle(on.entity, commands));
        steps(&mut witness.app, 120);
        witness.app.insert_resource(Gravity(Vector::NEG_Y * 10.0));
        witness.is_undisturbed();
    }
}

fn despawn(entity: &mut EntityWorldMut) {
    let id = entity.id();
    entity.world_scope(|world| world.despawn(id));
}

#[test]
fn whoever_sleeps_first_may_despawn_all_other_sleepers() {
    let mut witness = Witness::new();
    for i in 0..6 {
        resting(&mut witness.app, 0.99 * i as f32);
    }
    let despawn_others =
        |on: On<Add, Sleeping>, bodies: Query<(Entity, &RigidBody, &Position)>, mut commands: Commands| {
            for (entity, body, position) in &bodies {
                if body.is_dynamic() && entity != on.entity && !is_witness(position) {
                    commands.entity(entity).try_despawn();
                }
            }
        };
    witness.app.add_observer(despawn_others);
    witness.is_undisturbed();
}

#[test]
fn two_simulations_in_one_process_do_not_meet() {
    let (mut one, mut other) = (Witness::new(), Witness::new());
    let stray = other.spawn((RigidBody::Dynamic, ball(), at(-20.0, 3.0)));
    one.is_undisturbed();
    steps(&mut other.app, 20);
    other.app.world_mut().despawn(stray);
    one.is_undisturbed();
}
