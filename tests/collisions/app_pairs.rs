//! Pairs that the app adds to `ContactGraph` and removes from it, and reading the resource.

use super::*;
use avian::{collision::contact_types::ContactId, data_structures::pair_key::PairKey};
use bevy_ecs::system::RunSystemOnce;

/// An app without a broad phase but its own, which tests every two boxes.
fn own_broad_phase(add: impl Fn(&mut ContactGraph, ContactEdge) + Clone + Send + Sync + 'static) -> App {
    let mut app = App::new();
    let physics = PhysicsPlugins::new(Update).build().disable::<BvhBroadPhasePlugin>();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, physics));
    let find_pairs = move |colliders: Query<(Entity, &ColliderAabb)>, mut graph: ResMut<ContactGraph>| {
        for [(a, box_a), (b, box_b)] in colliders.iter_combinations() {
            if box_a.intersects(box_b) && !graph.contains(a, b) {
                add(&mut graph, ContactEdge::new(a, b));
            }
        }
    };
    app.add_systems(PhysicsSchedule, find_pairs.in_set(BroadPhaseSystems::CollectCollisions));
    listen(&mut app, PostUpdate);
    app.insert_resource(Gravity(Vector::Y * -9.81));
    app
}

/// A floor, and boxes of which each stands on the one before.
fn tower(app: &mut App, count: usize) -> Vec<Entity> {
    let floor = app.world_mut().spawn((RigidBody::Static, block(10.0, 1.0, 10.0), at(0.0, -0.5))).id();
    let body = |i: usize| {
        (RigidBody::Dynamic, block(1.0, 1.0, 1.0), at(0.0, 0.5 + i as f32), CollisionEventsEnabled)
    };
    let boxes: Vec<_> = (0..count).map(|i| app.world_mut().spawn(body(i)).id()).collect();
    core::iter::once(floor).chain(boxes).collect()
}

fn height(app: &App, entity: Entity) -> Scalar {
    app.world().get::<Position>(entity).expect("a body").y
}

#[test]
fn pairs_of_an_own_broad_phase_carry_a_tower() {
    let mut app = own_broad_phase(|graph, edge| _ = graph.add_edge(edge));
    let tower = tower(&mut app, 4);
    steps(&mut app, 256);
    for (i, body) in tower[1..].iter().enumerate() {
        let off = height(&app, *body) - (0.5 + i as Scalar);
        assert!(off.abs() < 0.01, "box {i} is off by {off}");
    }
    app.world_mut()
        .run_system_once(|collisions: Collisions| assert_eq!(collisions.iter().count(), 4))
        .expect("it runs");
    said(&mut app);
    let top = tower[4];
    app.world_mut().get_mut::<Position>(top).expect("a body").y += 5.0;
    step(&mut app);
    assert!(said(&mut app).contains(&Ended(tower[3], top)), "the contact ends where the boxes come apart");
    steps(&mut app, 256);
    assert!((height(&app, top) - 3.5).abs() < 0.01, "it is found again");
}

#[test]
fn pairs_without_constraints_touch_and_push_nothing() {
    let mut app = own_broad_phase(|graph, edge| {
        let id = graph.add_edge_with(edge, |pair| pair.flags.remove(ContactPairFlags::GENERATE_CONSTRAINTS));
        assert_eq!(id, Some(ContactId::PLACEHOLDER));
    });
    let tower = tower(&mut app, 1);
    step(&mut app);
    assert!(said(&mut app).contains(&Started(tower[0], tower[1])), "touching is reported");
    let flags = |app: &mut App| {
        let [a, b] = [tower[0], tower[1]];
        let read =
            move |collisions: Collisions| collisions.get(a, b).map(|pair| pair.generates_constraints());
        app.world_mut().run_system_once(read).expect("it runs")
    };
    assert_eq!(flags(&mut app), Some(false));
    // A new surface retypes the contact.
    app.world_mut().entity_mut(tower[1]).insert((Friction::new(0.1), CollisionMargin(0.01)));
    step(&mut app);
    assert_eq!(flags(&mut app), Some(false));
    steps(&mut app, 64);
    assert!(height(&app, tower[1]) < -1.0, "it falls through");
}

#[test]
fn impossible_pairs_make_no_contact() {
    let mut app = own_broad_phase(|_, _| ());
    let [left, right] = [CollisionLayers::new(1u32, 1u32), CollisionLayers::new(2u32, 2u32)];
    let mut spawn = |kind: RigidBody, layers: CollisionLayers| {
        app.world_mut().spawn((kind, ball(0.5), layers, at(0.0, 0.0))).id()
    };
    let walls = [spawn(RigidBody::Static, left), spawn(RigidBody::Static, left)];
    let [a, b] = [spawn(RigidBody::Dynamic, left), spawn(RigidBody::Dynamic, right)];
    let child = app.world_mut().spawn((ball(0.5), ChildOf(a), left, at(0.1, 0.0))).id();
    let [gone, bare] = [app.world_mut().spawn(ball(0.5)).id(), app.world_mut().spawn_empty().id()];
    step(&mut app);
    app.world_mut().despawn(gone);
    app.insert_resource(Gravity::ZERO);
    let pairs =
        [(a, a), (a, b), (a, child), (a, gone), (a, bare), (walls[0], walls[1]), (a, Entity::PLACEHOLDER)];
    for paused in [false, true] {
        let mut time = app.world_mut().resource_mut::<Time<Physics>>();
        if paused {
            time.pause();
        } else {
            time.unpause();
        }
        for (one, other) in pairs {
            app.world_mut().resource_mut::<ContactGraph>().add_edge(ContactEdge::new(one, other));
            app.world_mut().resource_mut::<ContactGraph>().remove_edge(one, other);
        }
        step(&mut app);
    }
    app.world_mut().resource_mut::<Time<Physics>>().unpause();
    // Twice, in either order, while paused or not: one contact.
    for (one, other) in [(a, walls[0]), (walls[0], a), (a, walls[0])] {
        assert!(
            app.world_mut().resource_mut::<ContactGraph>().add_edge(ContactEdge::new(one, other)).is_some()
        );
    }
    step(&mut app);
    step(&mut app);
    let graph = app.world().resource::<ContactGraph>().clone();
    let all: Vec<_> = graph.iter_active().map(|pair| [pair.collider1, pair.collider2]).collect();
    assert_eq!(all, [[walls[0], a]]);
    let again = app.world_mut().resource_mut::<ContactGraph>().add_edge(ContactEdge::new(a, walls[0]));
    assert_eq!(again, None, "the pair has a contact");
}

#[test]
fn removed_pairs_end_and_are_reported() {
    let mut app = app();
    let [wall, body] = touching(&mut app);
    step(&mut app);
    let id = app.world().resource::<ContactGraph>().get_edge(wall, body).map(|edge| edge.id);
    assert_eq!(id, None, "the first read is before the resource is filled");
    step(&mut app);
    let graph = &mut *app.world_mut().resource_mut::<ContactGraph>();
    let edge = graph.get_edge(body, wall).expect("it is filled since").clone();
    assert!(edge.is_touching() && edge.events_enabled());
    let removed = graph.remove_edge_by_id(&PairKey::new(wall.index_u32(), body.index_u32()), edge.id);
    assert_eq!(removed, Some(edge));
    said(&mut app);
    step(&mut app);
    assert!(said(&mut app).contains(&Ended(wall, body)));
    assert_eq!(app.world_mut().resource_mut::<ContactGraph>().remove_edge(wall, Entity::PLACEHOLDER), None);
}

#[test]
fn the_resource_is_what_collisions_are() {
    let mut app = app();
    app.insert_resource(Gravity(Vector::Y * -9.81));
    tower(&mut app, 3);
    app.add_systems(
        PhysicsSchedule,
        (
            (|graph: Res<ContactGraph>, collisions: Collisions, mut read: Local<u32>| {
                *read += 1;
                let pairs = graph.active_pairs();
                assert!(*read < 2 || pairs == collisions.graph().active_pairs());
                assert!(*read < 2 || pairs.iter().filter(|pair| pair.is_touching()).count() == 3);
            })
            .in_set(NarrowPhaseSystems::Last),
            (|graph: Res<ContactGraph>, collisions: Collisions, mut read: Local<u32>| {
                *read += 1;
                assert!(*read < 2 || graph.active_pairs() == collisions.graph().active_pairs());
                let pushed = |pair: &ContactPair| pair.total_normal_impulse_magnitude() > 0.0;
                assert!(*read < 3 || graph.iter_active_touching().all(pushed), "impulses are there");
            })
            .after(PhysicsStepSystems::Solver)
            .before(PhysicsStepSystems::Sleeping),
        ),
    );
    steps(&mut app, 20);
}
