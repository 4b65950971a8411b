//! Colliders that are despawned, or lose their shape: their collisions end at once, also while
//! physics is paused.

use super::*;
use bevy_ecs::system::RunSystemOnce;

fn frame(app: &mut App) {
    app.update();
}

fn pause(app: &mut App) {
    app.world_mut().resource_mut::<Time<Physics>>().pause();
}

/// The colliders that `Collisions` names as touching one, and the number of all pairs.
fn listed(app: &mut App, collider: Entity) -> (Vec<Entity>, usize) {
    let list = move |collisions: Collisions| {
        (collisions.entities_colliding_with(collider).collect(), collisions.iter().count())
    };
    app.world_mut().run_system_once(list).expect("a valid system")
}

#[test]
fn issue_despawned_colliders_stayed_in_the_sets_while_physics_was_paused() {
    type Change = fn(&mut World, Entity);
    let changes: [(&str, Change); 2] = [
        ("despawn", |world, e| _ = world.despawn(e)),
        ("collider removed", |world, e| _ = world.entity_mut(e).remove::<Collider>()),
    ];
    for paused in [false, true] {
        for (name, change) in changes {
            for side in [0, 1] {
                let mut app = app();
                let pair = touching(&mut app);
                assert_eq!(listed(&mut app, pair[1 - side]), (vec![pair[side]], 1));
                if paused {
                    pause(&mut app);
                    frame(&mut app);
                }
                let (gone, left) = (pair[side], pair[1 - side]);
                change(app.world_mut(), gone);
                let exists = app.world().get_entity(gone).is_ok();
                assert_eq!(touched(&app, left), [], "{name} {side}");
                assert_eq!(listed(&mut app, left), (vec![], 0), "{name} {side}");
                let seen = said(&mut app);
                assert!(seen.contains(&SawEnd(left, gone)), "{name} {side}: {seen:?}");
                assert_eq!(seen.len(), 1 + usize::from(exists), "{name} {side}: {seen:?}");
                if exists {
                    assert_eq!(touched(&app, gone), [], "{name} {side}");
                }
                frame(&mut app);
                assert_eq!(said(&mut app), [Ended(pair[0], pair[1])], "{name} {side}");
                app.world_mut().resource_mut::<Time<Physics>>().unpause();
                steps(&mut app, 3);
                assert_eq!(said(&mut app), [], "{name} {side}");
            }
        }
    }
}

/// A row of balls, each of which touches the next.
fn row(app: &mut App, count: usize) -> Vec<Entity> {
    let spawn = |i: usize| {
        let reporting = (CollisionEventsEnabled, CollidingEntities::default(), SleepingDisabled);
        let body = (RigidBody::Dynamic, ball(0.5), at(i as f32 * 0.998, 0.0), reporting);
        app.world_mut().spawn(body).id()
    };
    let row: Vec<Entity> = (0..count).map(spawn).collect();
    step(app);
    assert_eq!(said(app).iter().filter(|said| matches!(said, Started(..))).count(), count - 1);
    row
}

#[test]
fn despawns_of_one_flush_end_each_collision_once() {
    for paused in [false, true] {
        let mut app = app();
        let row = row(&mut app, 5);
        if paused {
            pause(&mut app);
        }
        let doomed = [row[1], row[2], row[3]];
        let despawn = move |mut commands: Commands| doomed.iter().for_each(|e| commands.entity(*e).despawn());
        app.world_mut().run_system_once(despawn).expect("a valid system");
        assert_eq!([touched(&app, row[0]), touched(&app, row[4])], [vec![], vec![]]);
        frame(&mut app);
        let all = said(&mut app);
        // An observer runs on a ball that still exists.
        let expected = [
            SawEnd(row[0], row[1]),
            SawEnd(row[2], row[1]),
            SawEnd(row[3], row[2]),
            SawEnd(row[4], row[3]),
            Ended(row[0], row[1]),
            Ended(row[1], row[2]),
            Ended(row[2], row[3]),
            Ended(row[3], row[4]),
        ];
        assert_eq!(all, expected, "paused: {paused}");
    }
}

/// Despawned with the first event.
#[derive(Resource)]
struct Doomed(Option<Entity>);

#[test]
fn what_an_observer_despawns_begins_to_touch_before_it_ends() {
    let mut app = app();
    app.insert_resource(Doomed(None)).add_observer(
        |_: On<CollisionStart>, mut doomed: ResMut<Doomed>, mut commands: Commands| {
            doomed.0.take().into_iter().for_each(|entity| commands.entity(entity).despawn());
        },
    );
    let spawn = |app: &mut App, x: f32| {
        let body = (RigidBody::Dynamic, ball(0.5), at(x, 0.0), CollisionEventsEnabled, SleepingDisabled);
        app.world_mut().spawn((body, CollidingEntities::default())).id()
    };
    let [a, b, c] = [0.0, 0.998, 1.996].map(|x| spawn(&mut app, x));
    app.insert_resource(Doomed(Some(b)));
    step(&mut app);
    let all = said(&mut app);
    let expected = [
        SawStart(a, b),
        SawStart(c, b),
        SawEnd(a, b),
        SawEnd(c, b),
        Started(a, b),
        Started(b, c),
        Ended(a, b),
        Ended(b, c),
    ];
    assert_eq!(all, expected);
    assert_eq!([touched(&app, a), touched(&app, c)], [vec![], vec![]]);
    steps(&mut app, 3);
    assert_eq!(said(&mut app), []);
}

#[test]
fn a_collider_that_gets_its_shape_again_collides_again() {
    for paused in [false, true] {
        let mut app = app();
        let [wall, body] = touching(&mut app);
        pause(&mut app);
        if paused {
            frame(&mut app);
        }
        app.world_mut().entity_mut(body).remove::<Collider>().insert(ball(0.5));
        frame(&mut app);
        assert_eq!(said(&mut app), [SawEnd(wall, body), SawEnd(body, wall), Ended(wall, body)]);
        app.world_mut().resource_mut::<Time<Physics>>().unpause();
        step(&mut app);
        assert_eq!(said(&mut app), [SawStart(wall, body), SawStart(body, wall), Started(wall, body)]);
        assert_eq!([touched(&app, wall), touched(&app, body)], [vec![body], vec![wall]]);
    }
}

#[test]
fn a_sleeper_whose_floor_is_despawned_while_paused_wakes_and_says_so() {
    let mut app = app();
    app.insert_resource(Gravity(Vector::NEG_Y * 9.81));
    let floor = app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y))).id();
    let body = app.world_mut().spawn((RigidBody::Dynamic, block(1.0, 1.0, 1.0), at(0.0, 0.6))).id();
    steps(&mut app, 200);
    assert!(app.world().get::<Sleeping>(body).is_some());
    pause(&mut app);
    app.world_mut().despawn(floor);
    (0..3).for_each(|_| frame(&mut app));
    app.world_mut().resource_mut::<Time<Physics>>().unpause();
    steps(&mut app, 10);
    assert!(app.world().get::<Sleeping>(body).is_none());
    assert!(app.world().get::<LinearVelocity>(body).is_some_and(|v| v.y < -1.0));
}

#[test]
fn the_graph_loses_despawned_colliders_and_keeps_the_rest() {
    let mut app = app();
    let mut row = row(&mut app, 12);
    let look = |graph: Res<ContactGraph>| graph.iter_active().count();
    app.world_mut().run_system_once(look).expect("a valid system");
    step(&mut app);
    pause(&mut app);
    for place in [3, 0, 5, 5, 2, 4] {
        app.world_mut().despawn(row.remove(place));
        let check = |graph: Res<ContactGraph>, collisions: Collisions| {
            let pairs = |graph: &ContactGraph| {
                let mut all: Vec<_> =
                    graph.iter_active().chain(graph.iter_sleeping()).map(|p| p.contact_id).collect();
                all.sort();
                all
            };
            let kept = pairs(&graph);
            assert_eq!(kept, pairs(collisions.graph()));
            for id in kept {
                let (edge, pair) = graph.get_by_id(id).expect("it is there");
                assert_eq!((edge.collider1, edge.collider2), (pair.collider1, pair.collider2));
                let found = graph.get(edge.collider2, edge.collider1).expect("it is there");
                assert_eq!(found.1, pair);
                for collider in [edge.collider1, edge.collider2] {
                    let count = graph.contact_pairs_with(collider).filter(|p| p.contact_id == id).count();
                    assert_eq!(count, 1);
                }
            }
        };
        app.world_mut().run_system_once(check).expect("a valid system");
    }
}
