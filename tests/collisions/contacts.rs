//! The content of `Collisions`.

use super::*;
use avian::{collision::contact_types::ContactId, data_structures::pair_key::PairKey};

/// Sees the contacts of a step where `system` runs.
fn look(
    set: impl IntoSystemSet<()> + 'static,
    read: fn(&Collisions) -> Vec<ContactPair>,
) -> (App, [Entity; 2]) {
    #[derive(Resource, Default)]
    struct Read(Vec<Vec<ContactPair>>);
    let mut app = app();
    let set = set.into_system_set();
    app.init_resource::<Read>().insert_resource(Gravity(Vector::NEG_Y * 10.0)).add_systems(
        PhysicsSchedule,
        (move |collisions: Collisions, mut all: ResMut<Read>| all.0.push(read(&collisions))).after(set),
    );
    let floor = (RigidBody::Static, Collider::half_space(Vector::Y), Friction::new(0.3));
    let floor = app.world_mut().spawn(floor).id();
    let body = (RigidBody::Dynamic, ball(0.5), at(0.0, 0.5), Mass(2.0), Friction::new(0.3), SleepingDisabled);
    let body = app.world_mut().spawn(body).id();
    steps(&mut app, 60);
    let read = app.world_mut().remove_resource::<Read>().expect("it was added");
    app.insert_resource(Last(read.0.last().expect("there were steps").clone()));
    (app, [floor, body])
}

#[derive(Resource)]
struct Last(Vec<ContactPair>);

#[test]
fn contacts_have_points_normals_and_impulses() {
    let all = |collisions: &Collisions| collisions.iter().cloned().collect();
    for is_late in [false, true] {
        let (app, [floor, body]) = if is_late {
            look(SolverSystems::StoreContactImpulses, all)
        } else {
            look(NarrowPhaseSystems::Update, all)
        };
        let pairs = &app.world().resource::<Last>().0;
        assert_eq!(pairs.len(), 1, "late: {is_late}");
        let pair = &pairs[0];
        assert_eq!([pair.collider1, pair.collider2], [floor, body]);
        assert_eq!([pair.body1, pair.body2], [Some(floor), Some(body)]);
        assert!(pair.is_touching() && pair.generates_constraints() && !pair.collision_started());
        assert!(
            pair.flags.contains(ContactPairFlags::STATIC1) && !pair.flags.contains(ContactPairFlags::STATIC2)
        );
        let weight = 2.0 * 10.0 * DT.as_secs_f32() as Scalar;
        assert!((pair.total_normal_impulse_magnitude() - weight).abs() < 0.02 * weight, "{pair:?}");
        assert!(pair.total_normal_impulse().distance(Vector::Y * weight) < 0.02 * weight, "{pair:?}");
        assert_eq!(pair.max_normal_impulse_magnitude(), pair.total_normal_impulse_magnitude());
        let [manifold] = &pair.manifolds[..] else { panic!("one manifold: {pair:?}") };
        assert!(manifold.normal.distance(Vector::Y) < 1.0e-6);
        assert!((manifold.friction - 0.3).abs() < 1.0e-6);
        let [point] = &manifold.points[..] else { panic!("one point: {pair:?}") };
        let place = app.world().get::<Position>(body).expect("a body").0;
        assert!(point.point.distance(place - Vector::Y * 0.5) < 0.01, "{point:?}");
        assert!(point.anchor2.distance(Vector::NEG_Y * 0.5) < 0.01, "{point:?}");
        assert!(point.penetration.abs() < 0.01 && point.normal_speed.abs() < 0.05, "{point:?}");
        assert!(point.warm_start_normal_impulse > 0.0);
        assert_eq!(manifold.find_deepest_contact(), Some(point));
        assert_eq!(pair.find_deepest_contact(), Some(point));
    }
}

#[test]
fn before_the_solver_a_point_has_the_speed_of_the_impact() {
    #[derive(Resource, Default)]
    struct Speeds(Vec<Scalar>);
    let mut app = app();
    app.init_resource::<Speeds>().add_systems(
        PhysicsSchedule,
        (|collisions: Collisions, mut speeds: ResMut<Speeds>| {
            let started = collisions.iter().filter(|pair| pair.collision_started());
            speeds.0.extend(started.filter_map(|pair| Some(pair.find_deepest_contact()?.normal_speed)));
        })
        .in_set(NarrowPhaseSystems::Last),
    );
    app.world_mut().spawn((RigidBody::Static, ball(0.5)));
    app.world_mut().spawn((RigidBody::Dynamic, ball(0.5), at(2.0, 0.0), right(-4.0)));
    steps(&mut app, 60);
    let speeds = &app.world().resource::<Speeds>().0;
    assert!(speeds.len() == 1 && (speeds[0] + 4.0).abs() < 1.0e-4, "{speeds:?}");
}

#[test]
fn contacts_are_found_by_colliders_in_any_order() {
    let mut app = app();
    let [wall, body] = touching(&mut app);
    let far = app.world_mut().spawn((RigidBody::Dynamic, ball(0.5), at(9.0, 0.0))).id();
    // Its box overlaps that of the wall, its shape does not.
    let near = app.world_mut().spawn((RigidBody::Dynamic, ball(0.5), at(-0.8, 0.8), SleepingDisabled)).id();
    step(&mut app);
    let check = move |collisions: Collisions| {
        let pair = collisions.get(wall, body).expect("they touch");
        assert!(core::ptr::eq(pair, collisions.get(body, wall).expect("they touch")), "made once");
        assert!(collisions.contains(body, wall) && !collisions.contains(wall, near));
        assert!(collisions.get(body, body).is_none() && collisions.get(wall, far).is_none());
        assert!(collisions.contains_key(&PairKey::new(body.index_u32(), wall.index_u32())));
        assert!(!collisions.contains_key(&PairKey::new(far.index_u32(), 70_000)));
        assert_eq!(collisions.collisions_with(body).collect::<Vec<_>>(), [pair]);
        assert_eq!(collisions.entities_colliding_with(wall).collect::<Vec<_>>(), [body]);
        assert_eq!(collisions.entities_colliding_with(far).count(), 0);
        assert_eq!(collisions.entities_colliding_with(Entity::PLACEHOLDER).count(), 0);

        let graph = collisions.graph();
        let (edge, same) = graph.get(body, wall).expect("they touch");
        assert!(edge.is_touching() && edge.events_enabled() && !edge.is_sleeping());
        assert_eq!((same, edge.id), (pair, pair.contact_id));
        assert_eq!(graph.get_by_id(edge.id), Some((edge, same)));
        assert!(graph.get_by_id(ContactId::PLACEHOLDER).is_none());
        assert!(graph.contains(wall, near) && !graph.contains(wall, far));
        assert_eq!(graph.entities_colliding_with(wall).collect::<Vec<_>>(), [body, near]);
        assert_eq!(graph.active_pairs().len(), 2);
        assert_eq!(graph.iter_active_touching().count(), 1);
        assert_eq!(graph.sleeping_pairs().len(), 0);
    };
    bevy_ecs::system::RunSystemOnce::run_system_once(app.world_mut(), check).expect("it runs");
    app.world_mut().entity_mut(body).remove::<SleepingDisabled>();
    app.world_mut().entity_mut(near).remove::<SleepingDisabled>();
    steps(&mut app, 120);
    let check = move |collisions: Collisions| {
        assert!(collisions.get(wall, body).is_some(), "also asleep");
        assert_eq!(collisions.graph().iter_sleeping_touching().count(), 1);
        assert_eq!(collisions.graph().active_pairs().len(), 0);
    };
    bevy_ecs::system::RunSystemOnce::run_system_once(app.world_mut(), check).expect("it runs");
    app.world_mut().despawn(wall);
    step(&mut app);
    let check = move |collisions: Collisions| assert_eq!(collisions.iter().count(), 0);
    bevy_ecs::system::RunSystemOnce::run_system_once(app.world_mut(), check).expect("it runs");
}

/// Impulses are known when events are sent.
#[test]
fn an_observer_reads_the_contact_that_began() {
    #[derive(Resource, Default)]
    struct Impulse(Scalar);
    let mut app = app();
    app.init_resource::<Impulse>().add_observer(
        |on: On<CollisionStart>, collisions: Collisions, mut impulse: ResMut<Impulse>| {
            let pair = collisions.get(on.collider1, on.collider2).expect("it began");
            assert!(pair.collision_started());
            impulse.0 = pair.total_normal_impulse_magnitude();
        },
    );
    app.insert_resource(Gravity(Vector::NEG_Y * 10.0));
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y), CollisionEventsEnabled));
    app.world_mut().spawn((RigidBody::Dynamic, ball(0.5), at(0.0, 0.5), Mass(2.0)));
    step(&mut app);
    let weight = 2.0 * 10.0 * DT.as_secs_f32() as Scalar;
    let impulse = app.world().resource::<Impulse>().0;
    assert!((impulse - weight).abs() < 0.1 * weight, "{impulse} N·s, weight {weight}");
}

/// A ball that rebounds within the step has left the floor before its last substep. The impulse is that of
/// the whole step.
#[test]
fn short_blows_have_their_impulse() {
    #[derive(Resource, Default)]
    struct Greatest(Scalar);
    for (listens, restitution) in [(false, 0.0), (false, 1.0), (true, 0.5), (true, 1.0)] {
        let mut app = app();
        app.init_resource::<Greatest>().insert_resource(Gravity(Vector::ZERO)).add_systems(
            PhysicsSchedule,
            (|collisions: Collisions, mut greatest: ResMut<Greatest>| {
                for pair in collisions.iter() {
                    greatest.0 = greatest.0.max(pair.max_normal_impulse_magnitude());
                }
            })
            .in_set(PhysicsStepSystems::Last),
        );
        let bounce = Restitution::new(restitution).with_combine_rule(CoefficientCombine::Max);
        app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
        let body = (RigidBody::Dynamic, ball(0.5), at(0.0, 1.0), Mass(2.0), bounce);
        let body = app.world_mut().spawn((body, LinearVelocity(Vector::NEG_Y * 5.0))).id();
        if listens {
            app.world_mut().entity_mut(body).insert(CollisionEventsEnabled);
        }
        steps(&mut app, 20);
        let expected = 2.0 * 5.0 * (1.0 + restitution);
        let greatest = app.world().resource::<Greatest>().0;
        assert!((greatest - expected).abs() < 0.03 * expected, "{greatest} N·s for {expected}");
    }
}

/// Most is proven by compiling.
#[test]
fn names_and_signatures_are_avians() {
    use avian::collision::contact_types::{ContactEdgeFlags, PackedFeatureId};
    fn is_event<T: Message + EntityEvent + Clone + Copy + core::fmt::Debug + PartialEq>() {}
    fn is_data<T: Clone + core::fmt::Debug + PartialEq>() {}
    is_event::<CollisionStart>();
    is_event::<CollisionEnd>();
    is_data::<ContactEdge>();
    is_data::<ContactPair>();
    is_data::<ContactManifold>();
    is_data::<ContactPoint>();
    let _: fn(Entity, Entity) -> ContactEdge = ContactEdge::new;
    let _: fn(Entity, Entity, ContactId) -> ContactPair = ContactPair::new;
    let _: fn(Vector, Vector, Vector, Scalar) -> ContactPoint = ContactPoint::new;
    let _: fn(&ContactPair) -> Vector = ContactPair::max_normal_impulse;
    let _: fn(&ContactManifold) -> Scalar = ContactManifold::total_normal_impulse;
    let _ = (CollisionEventsEnabled, CollidingEntities::default(), ContactGraph::default());
    assert_eq!([ContactEdgeFlags::TOUCHING, ContactEdgeFlags::CONTACT_EVENTS].map(|f| f.bits()), [1, 4]);
    assert_eq!(ContactPairFlags::all().bits(), (1 << 9) - 1);
    assert!(PackedFeatureId::vertex(3).is_vertex() && PackedFeatureId::face(3).is_face());
    assert!(PackedFeatureId::UNKNOWN.is_unknown());

    let point =
        |x: Scalar, depth: Scalar| ContactPoint::new(Vector::X * x, Vector::Y * x, Vector::X * x, depth);
    let mut manifold = ContactManifold::new([point(0.0, 0.1), point(1.0, 0.2)], Vector::Y);
    assert_eq!(manifold.find_deepest_contact(), Some(&point(1.0, 0.2)));
    assert_eq!(point(1.0, 0.2).flipped().anchor1, Vector::Y);
    let old = ContactPoint { warm_start_normal_impulse: 2.0, ..point(1.001, 0.0) };
    manifold.match_contacts(&[old], 0.01);
    assert_eq!(manifold.points.iter().map(|p| p.warm_start_normal_impulse).collect::<Vec<_>>(), [0.0, 2.0]);
}

#[test]
fn a_sensor_touches_all_bodies_that_are_in_one_place_and_they_come_apart() {
    let mut app = app();
    let sensor = (RigidBody::Dynamic, ball(20.0), Sensor, CollidingEntities::default(), at(0.0, 0.0));
    let sensor = app.world_mut().spawn(sensor).id();
    let mut crowd: Vec<Entity> = (0..100)
        .map(|i| {
            let body = (RigidBody::Dynamic, ball(0.25), at(0.001 * (i % 10) as f32, 0.001 * (i / 10) as f32));
            app.world_mut().spawn((body, CollidingEntities::default(), SleepingDisabled)).id()
        })
        .collect();
    crowd.sort();
    step(&mut app);
    assert_eq!(touched(&app, sensor), crowd);
    // Only some of the pairs have contacts, until these have pushed the bodies apart.
    assert!(crowd.iter().all(|ball| (10..60).contains(&touched(&app, *ball).len())));
    steps(&mut app, 60);
    // Ids are used again, and the rest is pushed apart.
    crowd[..30].iter().for_each(|ball| _ = app.world_mut().despawn(*ball));
    let late = (RigidBody::Dynamic, ball(0.25), at(0.0, 0.0), CollidingEntities::default(), SleepingDisabled);
    let late = app.world_mut().spawn(late).id();
    steps(&mut app, 900);
    let mut left = [&crowd[30..], &[late]].concat();
    left.sort();
    assert_eq!(touched(&app, sensor), left);
    let place = |ball: &Entity| app.world().get::<Position>(*ball).expect("it is a body").0;
    for (i, a) in left.iter().enumerate() {
        for b in &left[..i] {
            let distance = (place(a) - place(b)).length();
            assert!(distance > 0.48, "{a} and {b} are {distance} m apart");
        }
    }
}
