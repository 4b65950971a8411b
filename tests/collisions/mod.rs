//! Collision events: their receivers, time and order.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{entity_disabling::Disabled, prelude::*};
use bevy_time::{TimePlugin, TimeUpdateStrategy, prelude::*};
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;
use scenes::dim::{ball, block};

mod app_pairs;
mod contacts;
mod observers;
mod removal;
mod touch;

const DT: Duration = Duration::from_micros(15_625);

/// What was told, by message or to an observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Said {
    Started(Entity, Entity),
    Ended(Entity, Entity),
    SawStart(Entity, Entity),
    SawEnd(Entity, Entity),
}
use Said::*;

#[derive(Resource, Default)]
struct Log(Vec<Said>);

fn listen(app: &mut App, schedule: impl bevy_ecs::schedule::ScheduleLabel) {
    app.init_resource::<Log>()
        .insert_resource(Gravity::ZERO)
        .add_systems(
            schedule,
            |mut starts: MessageReader<CollisionStart>,
             mut ends: MessageReader<CollisionEnd>,
             mut log: ResMut<Log>| {
                log.0.extend(starts.read().map(|e| Started(e.collider1, e.collider2)));
                log.0.extend(ends.read().map(|e| Ended(e.collider1, e.collider2)));
            },
        )
        .add_observer(|on: On<CollisionStart>, mut log: ResMut<Log>| {
            log.0.push(SawStart(on.collider1, on.collider2));
        })
        .add_observer(|on: On<CollisionEnd>, mut log: ResMut<Log>| {
            log.0.push(SawEnd(on.collider1, on.collider2));
        });
    app.finish();
    app.cleanup();
}

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    listen(&mut app, PostUpdate);
    app
}

fn step(app: &mut App) {
    app.world_mut().resource_mut::<Time>().advance_by(DT);
    app.update();
}

fn steps(app: &mut App, count: u32) {
    (0..count).for_each(|_| step(app));
}

/// What was told since the last call.
fn said(app: &mut App) -> Vec<Said> {
    core::mem::take(&mut app.world_mut().resource_mut::<Log>().0)
}

fn at(x: f32, y: f32) -> Transform {
    Transform::from_xyz(x, y, 0.0)
}

fn right(speed: Scalar) -> LinearVelocity {
    LinearVelocity(Vector::X * speed)
}

/// A static ball and a dynamic one beside it, overlapping a little. Both report and track.
fn touching(app: &mut App) -> [Entity; 2] {
    let reporting = (CollisionEventsEnabled, CollidingEntities::default());
    let wall = app.world_mut().spawn((RigidBody::Static, ball(0.5), at(0.0, 0.0), reporting.clone())).id();
    let body = (RigidBody::Dynamic, ball(0.5), at(0.995, 0.0), reporting, SleepingDisabled);
    let body = app.world_mut().spawn(body).id();
    step(app);
    assert_eq!(
        said(app),
        [SawStart(wall, body), SawStart(body, wall), Started(wall, body)],
        "the message is read in PostUpdate, after the observers ran"
    );
    assert_eq!([touched(app, wall), touched(app, body)], [vec![body], vec![wall]]);
    [wall, body]
}

fn touched(app: &App, collider: Entity) -> Vec<Entity> {
    let mut all: Vec<Entity> =
        app.world().get::<CollidingEntities>(collider).expect("it tracks").iter().copied().collect();
    all.sort();
    all
}

#[test]
fn a_pair_is_told_once_of_its_start_and_once_of_its_end() {
    for (one, other) in [(true, true), (true, false), (false, true), (false, false)] {
        let mut app = app();
        let world = app.world_mut();
        let wall = world.spawn((RigidBody::Static, ball(0.5), Restitution::new(1.0))).id();
        let body = (RigidBody::Dynamic, ball(0.5), at(1.5, 0.0), right(-4.0), Restitution::new(1.0));
        let body = world.spawn(body).id();
        for (entity, reports) in [(wall, one), (body, other)] {
            if reports {
                world.entity_mut(entity).insert(CollisionEventsEnabled);
            }
        }
        steps(&mut app, 60);
        assert!(app.world().get::<Position>(body).expect("a body").x > 2.0, "it bounced");
        let all = said(&mut app);
        let count = |what: Said| all.iter().filter(|said| **said == what).count();
        let any = usize::from(one || other);
        assert_eq!([count(Started(wall, body)), count(Ended(wall, body))], [any; 2]);
        assert_eq!([count(SawStart(wall, body)), count(SawEnd(wall, body))], [usize::from(one); 2]);
        assert_eq!([count(SawStart(body, wall)), count(SawEnd(body, wall))], [usize::from(other); 2]);
        assert_eq!(all.len(), 2 * (any + usize::from(one) + usize::from(other)), "and nothing else");
    }
}

#[test]
fn events_name_the_bodies_of_child_colliders() {
    #[derive(Resource, Default)]
    struct Seen(Vec<[Option<Entity>; 2]>);
    let mut app = app();
    app.init_resource::<Seen>().add_observer(|on: On<CollisionStart>, mut seen: ResMut<Seen>| {
        seen.0.push([on.body1, on.body2]);
    });
    let wall = app.world_mut().spawn((Collider::half_space(Vector::Y), at(0.0, 0.0))).id();
    let body = app.world_mut().spawn((RigidBody::Dynamic, at(0.0, 0.4))).id();
    app.world_mut().spawn((ball(0.5), CollisionEventsEnabled, ChildOf(body)));
    step(&mut app);
    assert_eq!(app.world().resource::<Seen>().0, [[Some(body), None]]);
    assert!(app.world().get_entity(wall).is_ok());
}

#[test]
fn sensors_are_told_of_what_overlaps_them_and_not_of_what_passes_by() {
    let mut app = app();
    let sensor = (RigidBody::Static, Sensor, ball(0.5), CollisionEventsEnabled);
    let sensor = app.world_mut().spawn(sensor).id();
    let passing = (RigidBody::Dynamic, ball(0.5), at(-3.0, 1.01), right(8.0), SleepingDisabled);
    app.world_mut().spawn(passing);
    let resting = (RigidBody::Dynamic, ball(0.5), at(0.0, -1.005), SleepingDisabled);
    app.world_mut().spawn(resting);
    steps(&mut app, 60);
    assert_eq!(said(&mut app), []);
    let hit = (RigidBody::Dynamic, ball(0.5), at(-3.0, 0.9), right(8.0), SleepingDisabled);
    let hit = app.world_mut().spawn(hit).id();
    steps(&mut app, 60);
    let told = [SawStart(sensor, hit), Started(sensor, hit), SawEnd(sensor, hit), Ended(sensor, hit)];
    assert_eq!(said(&mut app), told);
    assert_eq!(app.world().get::<LinearVelocity>(hit), Some(&right(8.0)), "sensors push nothing");
}

/// Each pair is moved by the app: onto the other collider, then away.
#[test]
fn pairs_that_push_nothing_are_told_as_well() {
    let bodies = [Some(RigidBody::Static), Some(RigidBody::Kinematic), Some(RigidBody::Dynamic), None];
    for (i, one) in bodies.into_iter().enumerate() {
        for (j, other) in bodies.into_iter().enumerate() {
            for sensor in [false, true] {
                let mut app = app();
                let mut spawn = |body: Option<RigidBody>, x: f32| {
                    let mut entity = app.world_mut().spawn((ball(0.5), at(x, 0.0)));
                    if let Some(body) = body {
                        entity.insert(body);
                    }
                    entity.id()
                };
                let (still, moved) = (spawn(one, 0.0), spawn(other, 5.0));
                app.world_mut().entity_mut(moved).insert(CollisionEventsEnabled);
                if sensor {
                    app.world_mut().entity_mut(moved).insert(Sensor);
                }
                // Long enough for what is dynamic to fall asleep.
                steps(&mut app, 80);
                let pushes = i.max(j) == 2 && i.min(j) < 2 || [i, j] == [2, 2];
                let moves = [i, j].contains(&1) || [i, j].contains(&2);
                let bodiless = [one, other] == [None; 2];
                let told = moves || sensor && bodiless;
                assert!(pushes <= moves);
                *app.world_mut().get_mut::<Transform>(moved).expect("it is there") = at(0.9, 0.0);
                steps(&mut app, 1);
                let start = if told { 2 } else { 0 };
                let all = said(&mut app);
                assert_eq!(all.len(), start, "{one:?}, {other:?}, {sensor}: {all:?}");
                *app.world_mut().get_mut::<Transform>(moved).expect("it is there") = at(5.0, 0.0);
                steps(&mut app, 1);
                let all = said(&mut app);
                assert_eq!(all.len(), start, "{one:?}, {other:?}, {sensor}: {all:?}");
                assert!(app.world().get_entity(still).is_ok());
            }
        }
    }
}

/// The zone is moved, then the floor.
#[test]
fn issue_a_trigger_zone_without_a_body_was_told_of_the_floor_below_it() {
    let mut app = app();
    let floor = app.world_mut().spawn((RigidBody::Static, block(20.0, 1.0, 20.0), at(0.0, -0.5))).id();
    let zone = (ball(0.5), Sensor, at(0.0, 0.2), CollisionEventsEnabled, CollidingEntities::default());
    let zone = app.world_mut().spawn(zone).id();
    steps(&mut app, 3);
    for (entity, y) in [(zone, 0.1), (floor, -0.4), (zone, 0.3)] {
        app.world_mut().get_mut::<Transform>(entity).expect("it is there").translation.y = y;
        steps(&mut app, 2);
    }
    assert_eq!((said(&mut app), touched(&app, zone)), (vec![], vec![]));
    let body = app.world_mut().spawn((RigidBody::Dynamic, ball(0.5), at(0.5, 0.8), SleepingDisabled)).id();
    steps(&mut app, 2);
    assert_eq!(said(&mut app), [SawStart(zone, body), Started(zone, body)]);
    // As part of a body that may move it is.
    app.world_mut().despawn(body);
    steps(&mut app, 2);
    said(&mut app);
    app.world_mut().entity_mut(zone).insert(RigidBody::Kinematic);
    steps(&mut app, 2);
    assert_eq!(touched(&app, zone), [floor]);
    app.world_mut().entity_mut(zone).remove::<RigidBody>();
    steps(&mut app, 2);
    assert_eq!(touched(&app, zone), []);
}

#[test]
fn a_platform_is_told_of_walls_that_it_drives_into() {
    let mut app = app();
    let wall = app.world_mut().spawn((RigidBody::Static, ball(0.5))).id();
    let platform = (RigidBody::Kinematic, ball(0.5), at(-2.0, 0.0), right(2.0), CollisionEventsEnabled);
    let platform = app.world_mut().spawn(platform).id();
    steps(&mut app, 128);
    let told =
        [SawStart(platform, wall), Started(wall, platform), SawEnd(platform, wall), Ended(wall, platform)];
    assert_eq!(said(&mut app), told);
    assert!(app.world().get::<Position>(platform).expect("a body").x > 1.9, "walls do not stop it");
}

/// All that ends a collision without parting the shapes. In each case the other one still hears of it.
#[test]
fn a_collision_ends_with_whatever_takes_the_collider_out() {
    type Change = fn(&mut World, Entity);
    let changes: [(&str, Change); 8] = [
        ("despawn", |world, e| _ = world.despawn(e)),
        ("collider disabled", |world, e| _ = world.entity_mut(e).insert(ColliderDisabled)),
        ("entity disabled", |world, e| _ = world.entity_mut(e).insert(Disabled)),
        ("collider removed", |world, e| _ = world.entity_mut(e).remove::<Collider>()),
        ("layers", |world, e| _ = world.entity_mut(e).insert(CollisionLayers::NONE)),
        ("teleport", |world, e| _ = world.entity_mut(e).insert(at(50.0, 0.0))),
        ("despawn in an exclusive system", |world, e| _ = world.despawn(e)),
        ("body made static", |world, e| _ = world.entity_mut(e).insert(RigidBody::Static)),
    ];
    for (name, change) in changes {
        for side in [0, 1] {
            if side == 0 && name == "body made static" {
                continue;
            }
            let mut app = app();
            let pair = touching(&mut app);
            let (gone, left) = (pair[side], pair[1 - side]);
            change(app.world_mut(), gone);
            step(&mut app);
            let all = said(&mut app);
            let count = |what: Said| all.iter().filter(|said| **said == what).count();
            assert_eq!(count(SawEnd(left, gone)), 1, "{name} {side}: {all:?}");
            assert_eq!(count(Ended(pair[0], pair[1])), 1, "{name} {side}: {all:?}");
            let exists = app.world().get_entity(gone).is_ok();
            assert_eq!(count(SawEnd(gone, left)), usize::from(exists), "{name} {side}: {all:?}");
            assert_eq!(all.len(), 2 + usize::from(exists), "{name} {side}: {all:?}");
            assert_eq!(touched(&app, left), [], "{name} {side}");
            if exists {
                assert_eq!(touched(&app, gone), [], "{name} {side}");
            }
            steps(&mut app, 3);
            assert_eq!(said(&mut app), [], "{name} {side}");
        }
    }
}

#[test]
fn removing_a_body_ends_what_its_collider_may_not_touch_alone() {
    for disabled in [false, true] {
        let mut app = app();
        let [wall, body] = touching(&mut app);
        if disabled {
            app.world_mut().entity_mut(body).insert(RigidBodyDisabled);
        } else {
            app.world_mut().entity_mut(body).remove::<RigidBody>();
        }
        step(&mut app);
        assert_eq!(said(&mut app), [SawEnd(wall, body), SawEnd(body, wall), Ended(wall, body)]);
    }
}

#[test]
fn issue_sensors_and_kinematic_floors_were_not_told_of_disabled_and_removed_bodies() {
    let partners: [fn(&mut EntityWorldMut); 3] = [
        |partner| _ = partner.insert((RigidBody::Static, Sensor)),
        |partner| _ = partner.insert(Sensor),
        |partner| _ = partner.insert(RigidBody::Kinematic),
    ];
    let reporting = (CollisionEventsEnabled, CollidingEntities::default());
    for (kind, partner) in partners.into_iter().enumerate() {
        for disabled in [true, false] {
            let what = format!("partner {kind}, disabled: {disabled}");
            let mut app = app();
            let mut other = app.world_mut().spawn((ball(0.5), at(0.0, 0.0), reporting.clone()));
            partner(&mut other);
            let other = other.id();
            let body = (RigidBody::Dynamic, ball(0.5), at(0.995, 0.0), reporting.clone(), SleepingDisabled);
            let body = app.world_mut().spawn(body).id();
            step(&mut app);
            said(&mut app);
            assert_eq!([touched(&app, other), touched(&app, body)], [vec![body], vec![other]], "{what}");
            let mut entity = app.world_mut().entity_mut(body);
            if disabled {
                entity.insert(RigidBodyDisabled);
            } else {
                entity.remove::<RigidBody>();
            }
            step(&mut app);
            let ends = [SawEnd(other, body), SawEnd(body, other), Ended(other, body)];
            assert_eq!(said(&mut app), ends, "{what}");
            assert_eq!([touched(&app, other), touched(&app, body)], [vec![], vec![]], "{what}");
            steps(&mut app, 5);
            // Without its body, the collider meets the other one anew, unless that is on a static body.
            let starts = [SawStart(other, body), SawStart(body, other), Started(other, body)];
            let meets = !disabled && kind != 0;
            assert_eq!(said(&mut app), if meets { &starts[..] } else { &starts[..0] }, "{what}");
            if disabled {
                app.world_mut().entity_mut(body).remove::<RigidBodyDisabled>();
                step(&mut app);
                let all = said(&mut app);
                assert!(all.contains(&Started(other, body)) && all.len() == 3, "{what}: {all:?}");
            }
        }
    }
}

#[test]
fn of_two_despawned_one_after_the_other_the_second_is_told() {
    let mut app = app();
    let [wall, body] = touching(&mut app);
    app.world_mut().despawn(wall);
    app.world_mut().despawn(body);
    step(&mut app);
    assert_eq!(said(&mut app), [SawEnd(body, wall), Ended(wall, body)]);
}

#[test]
fn what_is_despawned_within_the_step_ends_in_it() {
    #[derive(Resource)]
    struct Doomed(Option<Entity>);
    let mut app = app();
    app.add_systems(
        PhysicsSchedule,
        (|world: &mut World| {
            if let Some(entity) = world.resource_mut::<Doomed>().0.take() {
                world.despawn(entity);
            }
        })
        .in_set(NarrowPhaseSystems::Last),
    )
    .insert_resource(Doomed(None));
    let [wall, body] = touching(&mut app);
    app.insert_resource(Doomed(Some(wall)));
    step(&mut app);
    assert_eq!(said(&mut app), [SawEnd(body, wall), Ended(wall, body)]);
}

#[test]
fn falling_asleep_ends_nothing() {
    let mut app = app();
    app.insert_resource(Gravity(Vector::NEG_Y * 9.81));
    let floor = app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y))).id();
    let body = (RigidBody::Dynamic, block(1.0, 1.0, 1.0), at(0.0, 0.6), CollisionEventsEnabled);
    let body = app.world_mut().spawn((body, CollidingEntities::default())).id();
    steps(&mut app, 200);
    assert!(app.world().get::<Sleeping>(body).is_some());
    assert_eq!(said(&mut app), [SawStart(body, floor), Started(floor, body)]);
    assert_eq!(touched(&app, body), [floor]);
    app.world_mut().entity_mut(body).remove::<Sleeping>();
    steps(&mut app, 5);
    assert_eq!(said(&mut app), []);
    app.world_mut().despawn(floor);
    step(&mut app);
    assert_eq!(said(&mut app), [SawEnd(body, floor), Ended(floor, body)]);
}

#[test]
fn a_collider_that_moves_to_another_body_keeps_what_it_touches() {
    let mut app = app();
    let wall = app.world_mut().spawn((RigidBody::Static, ball(0.5), CollisionEventsEnabled)).id();
    let body = || (RigidBody::Dynamic, at(0.9, 0.0), SleepingDisabled);
    let (one, other) = (app.world_mut().spawn(body()).id(), app.world_mut().spawn(body()).id());
    let part = (ball(0.5), CollisionEventsEnabled, CollidingEntities::default(), ChildOf(one));
    let part = app.world_mut().spawn(part).id();
    step(&mut app);
    assert_eq!(said(&mut app).len(), 3);
    app.world_mut().entity_mut(other).insert(at(0.9, 0.0));
    app.world_mut().entity_mut(part).insert(ChildOf(other));
    step(&mut app);
    assert_eq!(app.world().get::<ColliderOf>(part).map(|of| of.body), Some(other));
    assert_eq!(said(&mut app), []);
    assert_eq!(touched(&app, part), [wall]);
}

#[test]
fn reporting_may_begin_and_stop_at_any_time() {
    let mut app = app();
    let wall = app.world_mut().spawn((RigidBody::Static, ball(0.5))).id();
    let body = app.world_mut().spawn((RigidBody::Dynamic, ball(0.5), at(0.99, 0.0), SleepingDisabled)).id();
    steps(&mut app, 3);
    assert_eq!(said(&mut app), []);
    app.world_mut().entity_mut(body).insert((CollisionEventsEnabled, CollidingEntities::default()));
    step(&mut app);
    assert_eq!(said(&mut app), [], "it touched before");
    assert_eq!(touched(&app, body), [wall]);
    app.world_mut().entity_mut(body).insert(at(5.0, 0.0));
    step(&mut app);
    assert_eq!(said(&mut app), [SawEnd(body, wall), Ended(wall, body)]);
    app.world_mut().entity_mut(body).insert(at(0.99, 0.0));
    step(&mut app);
    assert_eq!(said(&mut app), [SawStart(body, wall), Started(wall, body)]);
    app.world_mut().entity_mut(body).remove::<CollisionEventsEnabled>().insert(at(5.0, 0.0));
    step(&mut app);
    assert_eq!(said(&mut app), []);
    assert_eq!(touched(&app, body), []);
}

#[test]
fn changes_during_a_pause_are_told_at_once_if_the_collider_is_gone_and_else_in_the_next_step() {
    let mut app = app();
    let [wall, body] = touching(&mut app);
    app.world_mut().resource_mut::<Time<Physics>>().pause();
    steps(&mut app, 5);
    app.world_mut().entity_mut(wall).insert(ColliderDisabled);
    steps(&mut app, 5);
    assert_eq!(said(&mut app), []);
    app.world_mut().entity_mut(wall).remove::<ColliderDisabled>();
    app.world_mut().despawn(wall);
    steps(&mut app, 5);
    assert_eq!(said(&mut app), [SawEnd(body, wall), Ended(wall, body)]);
    app.world_mut().resource_mut::<Time<Physics>>().unpause();
    step(&mut app);
    assert_eq!(said(&mut app), []);
}

/// A collider that is disabled and enabled between two steps still touches.
#[test]
fn what_ends_and_begins_between_two_steps_is_not_told() {
    let mut app = app();
    let [_, body] = touching(&mut app);
    app.world_mut().entity_mut(body).insert(ColliderDisabled).remove::<ColliderDisabled>();
    step(&mut app);
    assert_eq!(said(&mut app), []);
    app.world_mut().entity_mut(body).insert(CollidingEntities::default());
    step(&mut app);
    assert_eq!(touched(&app, body).len(), 1, "the set is filled again");
}

/// At 30, 64 and 144 frames a second each message reaches a system in `Update` once, and the steps
/// tell the same.
#[test]
fn each_message_is_read_once_at_any_frame_rate() {
    let run = |rate: u32| {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()));
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs(1) / rate));
        listen(&mut app, Update);
        app.insert_resource(Gravity(Vector::NEG_Y * 9.81));
        app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y), Restitution::new(1.0)));
        for i in 0..5u8 {
            let place = at(f32::from(i) * 3.0, 1.0 + 0.3 * f32::from(i));
            let body = (RigidBody::Dynamic, ball(0.5), place, CollisionEventsEnabled);
            app.world_mut().spawn(body);
        }
        (0..4 * rate).for_each(|_| app.update());
        let all = said(&mut app);
        let messages = all.iter().filter(|said| matches!(said, Started(..) | Ended(..))).count();
        assert_eq!(2 * messages, all.len(), "an observer ran for each message");
        all.into_iter().filter(|said| matches!(said, SawStart(..) | SawEnd(..))).collect::<Vec<_>>()
    };
    let [slow, even, fast] = [30, 64, 144].map(run);
    assert!(even.len() > 20, "{} events", even.len());
    let least = slow.len().min(even.len()).min(fast.len());
    assert!(least + 4 >= even.len(), "{} {} {}", slow.len(), even.len(), fast.len());
    assert_eq!(slow[..least], even[..least]);
    assert_eq!(fast[..least], even[..least]);
}
