//! The transform tree, the links of colliders to bodies, and the entities that traversals visit.

use super::*;

#[test]
fn links_follow_the_hierarchy() {
    let mut app = app();
    // The child is spawned first.
    let collider = app.world_mut().spawn((ColliderMarker, place(1.0, 0.0))).id();
    let middle = app.world_mut().spawn(place(0.0, 0.0)).id();
    let body = app.world_mut().spawn((RigidBody::Dynamic, place(10.0, 0.0))).id();
    app.world_mut().entity_mut(middle).add_child(collider);
    app.world_mut().entity_mut(body).add_child(middle);
    step(&mut app);
    let owner = |app: &App| app.world().get::<ColliderOf>(collider).map(|of| of.body);
    assert_eq!(owner(&app), Some(body));
    assert_at(&app, collider, at(11.0, 0.0));
    // A body in between becomes the owner, until it is removed.
    app.world_mut().entity_mut(middle).insert(RigidBody::Kinematic);
    step(&mut app);
    assert_eq!(owner(&app), Some(middle));
    assert!(app.world().get::<RigidBodyColliders>(body).is_none());
    app.world_mut().entity_mut(middle).remove::<RigidBody>();
    step(&mut app);
    assert_eq!(owner(&app), Some(body));
    // Reparented with all entities between.
    let other = app.world_mut().spawn((RigidBody::Dynamic, place(-10.0, 0.0))).id();
    app.world_mut().entity_mut(other).add_child(middle);
    assert_eq!(owner(&app), Some(other), "linked at once");
    step(&mut app);
    assert_eq!(owner(&app), Some(other));
    assert_at(&app, collider, at(-9.0, 0.0));
    // Without a body, there is no link.
    app.world_mut().entity_mut(other).remove::<RigidBody>();
    step(&mut app);
    assert_eq!(owner(&app), None);
    assert_at(&app, collider, at(-9.0, 0.0));
    // Without a collider, there is no link.
    app.world_mut().entity_mut(other).insert(RigidBody::Static);
    app.world_mut().entity_mut(collider).remove::<ColliderMarker>();
    step(&mut app);
    assert_eq!(owner(&app), None);
    assert!(app.world().get::<RigidBodyColliders>(other).is_none());
}

#[test]
fn a_detached_collider_outlives_its_body() {
    let mut app = app();
    let body = app.world_mut().spawn((RigidBody::Dynamic, ColliderMarker)).id();
    let middle = app.world_mut().spawn((Transform::default(), ChildOf(body))).id();
    let collider = app.world_mut().spawn((ColliderMarker, ChildOf(middle))).id();
    let stays = app.world_mut().spawn((ColliderMarker, ChildOf(body))).id();
    step(&mut app);
    app.world_mut().entity_mut(middle).remove::<ChildOf>();
    app.world_mut().despawn(body);
    step(&mut app);
    assert!(app.world().get_entity(collider).is_ok());
    assert!(app.world().get_entity(stays).is_err());
    assert!(app.world().get::<ColliderOf>(collider).is_none());
    app.world_mut().despawn(middle);
    step(&mut app);
    assert_eq!(app.world().resource::<TransformTree>().len(), 0);
}

#[test]
fn observers_may_remove_what_is_being_linked() {
    let mut app = app();
    app.add_observer(|added: On<Add, ColliderOf>, of: Query<&ColliderOf>, mut commands: Commands| {
        let body = of.get(added.event_target()).unwrap().body;
        commands.entity(body).despawn();
    });
    let body = app.world_mut().spawn((RigidBody::Dynamic, ColliderMarker)).id();
    for _ in 0..3 {
        app.world_mut().spawn((ColliderMarker, ChildOf(body)));
    }
    step(&mut app);
    step(&mut app);
    assert!(app.world().get_entity(body).is_err());
    assert_eq!(app.world().resource::<TransformTree>().len(), 0);
}

#[test]
fn observers_of_one_link_may_change_the_other_bodies() {
    let mut app = app();
    let bodies: [Entity; 4] = core::array::from_fn(|_| app.world_mut().spawn(ColliderMarker).id());
    let [first, gone, unbodied, bare] = bodies;
    let child = app.world_mut().spawn((ColliderMarker, ChildOf(unbodied))).id();
    app.add_observer(move |added: On<Add, ColliderOf>, mut commands: Commands| {
        if added.event_target() == first {
            commands.entity(gone).despawn();
            commands.entity(unbodied).remove::<RigidBody>();
            commands.entity(bare).remove::<ColliderMarker>();
        }
    });
    // Spawned and linked in one batch.
    app.world_mut().insert_batch(bodies.map(|body| (body, RigidBody::Dynamic)));
    assert_eq!(app.world().get::<ColliderOf>(child), None, "its body was none when its turn came");
    step(&mut app);
    assert!(app.world().get_entity(gone).is_err());
    for entity in [unbodied, bare] {
        assert_eq!(app.world().get::<ColliderOf>(entity), None);
        assert_eq!(app.world().get::<RigidBodyColliders>(entity), None);
    }
    assert_eq!(app.world().get::<RigidBodyColliders>(first).map(|list| list.to_vec()), Some(vec![first]));
}

#[test]
fn the_rest_of_the_scene_is_not_visited() {
    let mut app = app();
    let root = app.world_mut().spawn(place(0.0, 0.0)).id();
    let pictures: Vec<_> = (0..100_000).map(|_| (place(0.0, 0.0), ChildOf(root))).collect();
    app.world_mut().spawn_batch(pictures);
    let body = app.world_mut().spawn((RigidBody::Dynamic, place(1.0, 0.0), ChildOf(root))).id();
    step(&mut app);
    assert_eq!(app.world().resource::<TransformTree>().len(), 2);
    let visited = |app: &App| app.world().resource::<TransformTree>().visited;
    let before = visited(&app);
    step(&mut app);
    assert_eq!(visited(&app), before, "nothing changed, nothing is walked");
    set(&mut app, root, place(2.0, 0.0));
    step(&mut app);
    assert_at(&app, body, at(3.0, 0.0));
    let more = visited(&app) - before;
    assert!(more == 6, "two entities, three walks: placing, propagating, attaching; not {more}");
}

#[test]
fn a_body_with_nothing_but_colliders_below_is_not_walked() {
    let mut app = app();
    let body = app.world_mut().spawn((RigidBody::Dynamic, place(0.0, 0.0))).id();
    let collider = app.world_mut().spawn((ColliderMarker, place(1.0, 0.0), ChildOf(body))).id();
    step(&mut app);
    let visited = |app: &App| app.world().resource::<TransformTree>().visited;
    let before = visited(&app);
    move_body(&mut app, body, at(3.0, 0.0), None);
    step(&mut app);
    assert_shown_at(&mut app, body);
    assert_at(&app, collider, at(4.0, 0.0));
    assert_eq!(visited(&app), before);
    // The collider becomes a body itself.
    app.world_mut().entity_mut(collider).insert(RigidBody::Dynamic);
    step(&mut app);
    move_body(&mut app, body, at(5.0, 0.0), None);
    step(&mut app);
    assert_at(&app, collider, at(4.0, 0.0));
    assert_shown_at(&mut app, collider);
    assert!(visited(&app) > before);
}

#[test]
fn a_family_may_be_turned_upside_down_at_once() {
    let mut app = app();
    let a = app.world_mut().spawn((RigidBody::Dynamic, place(0.0, 0.0))).id();
    let b = app.world_mut().spawn((RigidBody::Dynamic, place(1.0, 0.0), ChildOf(a))).id();
    step(&mut app);
    app.world_mut().entity_mut(a).remove::<RigidBody>();
    app.world_mut().entity_mut(b).remove::<ChildOf>();
    app.world_mut().entity_mut(a).insert(ChildOf(b));
    step(&mut app);
    assert_eq!(app.world().resource::<TransformTree>().parent(a), Some(b));
    move_body(&mut app, b, at(3.0, 0.0), None);
    step(&mut app);
    assert_shown_at(&mut app, b);
}

#[test]
fn a_body_may_be_hung_below_another_within_a_step() {
    let mut app = app();
    let [outer, inner] = [0.0, 1.0].map(|x| app.world_mut().spawn((RigidBody::Dynamic, place(x, 0.0))).id());
    step(&mut app);
    let hang = move |mut commands: Commands, mut done: Local<bool>| {
        if !core::mem::replace(&mut *done, true) {
            commands.entity(inner).insert(ChildOf(outer));
        }
    };
    app.add_systems(Update, hang.in_set(PhysicsSystems::StepSimulation));
    move_body(&mut app, inner, at(5.0, 0.0), None);
    move_body(&mut app, outer, at(2.0, 0.0), None);
    for _ in 0..2 {
        step(&mut app);
        assert_at(&app, inner, at(5.0, 0.0));
        assert_shown_at(&mut app, inner);
        assert_shown_at(&mut app, outer);
    }
}

proptest! {
    #[test]
    fn the_tree_and_the_links_survive_any_life(ops in prop::collection::vec((0u8..10, 0usize..12, 0usize..12), 1..60)) {
        let mut app = app();
        let mut all: Vec<Entity> = (0..12).map(|_| app.world_mut().spawn(Transform::default()).id()).collect();
        for (op, a, b) in ops {
            let (entity, other) = (all[a], all[b]);
            let is_above = core::iter::successors(Some(other), |&e| app.world().get::<ChildOf>(e).map(ChildOf::parent))
                .any(|e| e == entity);
            let alive = |app: &App, e| app.world().get_entity(e).is_ok();
            if !alive(&app, entity) {
                all[a] = app.world_mut().spawn(Transform::default()).id();
                continue;
            }
            match op {
                0 => { app.world_mut().entity_mut(entity).insert(RigidBody::Dynamic); }
                1 => { app.world_mut().entity_mut(entity).remove::<RigidBody>(); }
                2 => { app.world_mut().entity_mut(entity).insert(ColliderMarker); }
                3 => { app.world_mut().entity_mut(entity).remove::<ColliderMarker>(); }
                4 | 5 if !is_above && alive(&app, other) => { app.world_mut().entity_mut(entity).insert(ChildOf(other)); }
                6 => { app.world_mut().entity_mut(entity).remove::<ChildOf>(); }
                7 => { app.world_mut().despawn(entity); }
                8 if app.world().get::<ApplyPosToTransform>(entity).is_some() => {
                    app.world_mut().entity_mut(entity).remove::<ApplyPosToTransform>();
                }
                8 => { app.world_mut().entity_mut(entity).insert(ApplyPosToTransform); }
                9 if app.world().get::<RigidBody>(entity).is_some() => {
                    move_body(&mut app, entity, at(a as Scalar, b as Scalar), None);
                    step(&mut app);
                    let bodies = all.iter().filter(|e| alive(&app, **e));
                    let bodies: Vec<_> = bodies.copied().filter(|e| app.world().get::<RigidBody>(*e).is_some()).collect();
                    bodies.iter().for_each(|body| assert_shown_at(&mut app, *body));
                }
                _ => { step(&mut app); check_links(&app, &all); }
            }
        }
        step(&mut app);
        check_links(&app, &all);
    }
}

/// Checks that every collider is linked to the nearest body, which is found by brute force.
fn check_links(app: &App, all: &[Entity]) {
    let world = app.world();
    for &entity in all.iter().filter(|&&e| world.get_entity(e).is_ok()) {
        let line = core::iter::successors(Some(entity), |&e| world.get::<ChildOf>(e).map(ChildOf::parent));
        let body = line.into_iter().find(|&e| world.get::<RigidBody>(e).is_some());
        let wanted = body.filter(|_| world.get::<ColliderMarker>(entity).is_some());
        assert_eq!(world.get::<ColliderOf>(entity).map(|of| of.body), wanted);
        let listed = |body| world.get::<RigidBodyColliders>(body).is_some_and(|list| list.contains(&entity));
        assert!(wanted.is_none_or(listed));
    }
}
