//! The order of collision events, and observers that act on what they hear.

use super::*;
use avian::dynamics::solver::WorkerCount;

#[test]
fn the_order_is_the_same_with_any_number_of_workers() {
    let run = |workers: usize| {
        let mut app = app();
        app.insert_resource(Gravity(Vector::NEG_Y * 9.81)).insert_resource(WorkerCount(workers));
        app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
        for i in 0..120u8 {
            let place = at(f32::from(i % 10) * 1.01, 0.6 + 1.1 * f32::from(i / 10));
            let body = (RigidBody::Dynamic, ball(0.5), place, right(Scalar::from(i % 3)));
            app.world_mut().spawn((body, CollisionEventsEnabled));
        }
        steps(&mut app, 90);
        said(&mut app)
    };
    let one = run(1);
    assert!(one.len() > 500, "{} events", one.len());
    assert_eq!(one, run(2));
    assert_eq!(one, run(4));
}

#[test]
fn observers_may_despawn_the_other_collider_and_their_own() {
    for own in [false, true] {
        let mut app = app();
        app.add_observer(move |on: On<CollisionStart>, mut commands: Commands| {
            commands.entity(if own { on.collider1 } else { on.collider2 }).despawn();
        });
        let reporting = CollisionEventsEnabled;
        let wall = app.world_mut().spawn((RigidBody::Static, ball(0.5), reporting)).id();
        let body = app.world_mut().spawn((RigidBody::Dynamic, ball(0.5), at(0.9, 0.0), reporting)).id();
        let third = app.world_mut().spawn((RigidBody::Dynamic, ball(0.5), at(-0.9, 0.0), reporting)).id();
        steps(&mut app, 4);
        let all = said(&mut app);
        let count = |what: Said| all.iter().filter(|said| **said == what).count();
        for other in [body, third] {
            assert_eq!([count(Started(wall, other)), count(Ended(wall, other))], [1; 2], "{all:?}");
        }
        let left = [wall, body, third].into_iter().filter(|e| app.world().get_entity(*e).is_ok()).count();
        assert_eq!(left, usize::from(!own), "{all:?}");
    }
}

#[test]
fn observers_may_despawn_all_colliders() {
    let mut app = app();
    app.add_observer(|on: On<CollisionEnd>, mut commands: Commands| {
        commands.queue(|world: &mut World| {
            let all: Vec<Entity> = world.query_filtered::<Entity, With<Collider>>().iter(world).collect();
            all.into_iter().for_each(|entity| _ = world.despawn(entity));
        });
        assert_ne!(on.collider1, on.collider2);
    });
    let [wall, body] = touching(&mut app);
    app.world_mut().entity_mut(wall).insert(ColliderDisabled);
    steps(&mut app, 3);
    assert_eq!(said(&mut app), [SawEnd(wall, body), Ended(wall, body)]);
}

#[test]
fn an_observer_on_a_collider_hears_of_it_first_and_one_on_its_body_nothing() {
    #[derive(Resource, Default)]
    struct Heard(Vec<[Entity; 3]>);
    fn hear(on: On<CollisionStart>, mut heard: ResMut<Heard>) {
        heard.0.push([on.event_target(), on.collider1, on.collider2]);
    }
    let mut app = app();
    app.init_resource::<Heard>();
    let world = app.world_mut();
    let wall = world.spawn((RigidBody::Static, ball(0.5), CollisionEventsEnabled)).observe(hear).id();
    let body = world.spawn((RigidBody::Dynamic, at(0.9, 0.0), SleepingDisabled)).observe(hear).id();
    let part = world.spawn((ball(0.5), CollisionEventsEnabled, ChildOf(body))).observe(hear).id();
    step(&mut app);
    let heard = &app.world().resource::<Heard>().0;
    assert_eq!(heard.len(), 2, "{heard:?}");
    assert!(heard.contains(&[wall, wall, part]) && heard.contains(&[part, part, wall]), "{heard:?}");
}

#[test]
fn all_starts_of_a_step_are_told_before_its_ends() {
    let mut app = app();
    let [wall, body] = touching(&mut app);
    let other = app.world_mut().spawn((RigidBody::Static, ball(0.5), at(5.0, 0.0))).id();
    app.world_mut().entity_mut(body).insert(at(4.005, 0.0));
    step(&mut app);
    let told = [SawStart(body, other), SawEnd(wall, body), SawEnd(body, wall)];
    assert_eq!(said(&mut app)[..3], told);
}

#[test]
fn events_are_sent_in_their_set_at_the_end_of_the_step() {
    use avian::collision::narrow_phase::CollisionEventSystems;
    #[derive(Resource, Default)]
    struct Sent([usize; 2]);
    fn count<const I: usize>(messages: Res<Messages<CollisionStart>>, mut sent: ResMut<Sent>) {
        sent.0[I] = messages.len();
    }
    let mut app = app();
    app.init_resource::<Sent>().add_systems(
        PhysicsSchedule,
        (
            count::<0>.after(PhysicsStepSystems::Sleeping).before(CollisionEventSystems),
            count::<1>.after(CollisionEventSystems).before(PhysicsStepSystems::Last),
        ),
    );
    touching(&mut app);
    assert_eq!(app.world().resource::<Sent>().0, [0, 1]);
}
