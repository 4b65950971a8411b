//! Spatial queries in an app: they see the world as it is, and find what looking at all colliders finds.

use avian::{
    math::{Dir, Scalar, Vector},
    parry::shape::SharedShape,
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, system::RunSystemOnce};
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;
use proptest::prelude::*;

pub const ALL: SpatialQueryFilter = SpatialQueryFilter::DEFAULT;

pub fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.finish();
    app.cleanup();
    app
}

pub fn step(app: &mut App) {
    app.world_mut().resource_mut::<Time>().advance_by(Duration::from_millis(16));
    app.update();
}

/// A box with sides of 1 m.
pub fn cube() -> Collider {
    let mut corners = vec![Vector::ZERO];
    for axis in Vector::AXES {
        corners = corners.iter().flat_map(|c| [*c - axis * 0.5, *c + axis * 0.5]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

pub fn at(x: f32) -> Transform {
    Transform::from_xyz(x, 0.0, 0.0)
}

/// What a query gives, asked by a system of its own.
pub fn ask<R: Send + Sync + 'static>(
    app: &mut App,
    question: impl Fn(&SpatialQuery) -> R + Send + Sync + 'static,
) -> R {
    app.world_mut().run_system_once(move |queries: SpatialQuery| question(&queries)).expect("the system runs")
}

/// The first hit of a ray along the x axis, from x = -10 m: entity and distance.
fn first(app: &mut App) -> Option<(Entity, Scalar)> {
    let hit = ask(app, |q| q.cast_ray(Vector::X * -10.0, Dir::X, 100.0, true, &ALL));
    hit.map(|hit| (hit.entity, hit.distance))
}

#[track_caller]
fn assert_first(app: &mut App, expected: Option<(Entity, Scalar)>) {
    let found = first(app);
    let same = match (found, expected) {
        (Some(found), Some(expected)) => found.0 == expected.0 && (found.1 - expected.1).abs() < 1.0e-4,
        (found, expected) => found == expected,
    };
    assert!(same, "{found:?} and not {expected:?}");
}

/// Everything that the app changes is seen at once, also while physics is paused, also before the first step.
#[test]
fn changes_are_seen_before_the_next_step() {
    for (paused, stepped) in [(false, true), (true, true), (false, false), (true, false)] {
        let mut app = app();
        let settle = |app: &mut App| {
            if stepped {
                step(app);
            }
        };
        app.insert_resource(Gravity::ZERO);
        if paused {
            app.world_mut().resource_mut::<Time<Physics>>().pause();
        }
        assert_first(&mut app, None);
        let body = app.world_mut().spawn((RigidBody::Static, cube(), at(3.0))).id();
        assert_first(&mut app, Some((body, 12.5)));
        settle(&mut app);
        assert_first(&mut app, Some((body, 12.5)));
        app.world_mut().get_mut::<Position>(body).expect("a pose").0 = Vector::X * 5.0;
        assert_first(&mut app, Some((body, 14.5)));
        settle(&mut app);
        assert_first(&mut app, Some((body, 14.5)));
        app.world_mut().get_mut::<Collider>(body).expect("a shape").set_scale(Vector::ONE * 2.0, 10);
        assert_first(&mut app, Some((body, 14.0)));
        app.world_mut().entity_mut(body).insert(cube());
        assert_first(&mut app, Some((body, 14.5)));
        settle(&mut app);
        app.world_mut().entity_mut(body).insert(ColliderDisabled);
        assert_first(&mut app, None);
        settle(&mut app);
        assert_first(&mut app, None);
        app.world_mut().entity_mut(body).remove::<ColliderDisabled>();
        assert_first(&mut app, Some((body, 14.5)));
        settle(&mut app);

        // A collider alone, and one on a child, which moves with its body.
        let alone = app.world_mut().spawn((cube(), at(0.0))).id();
        assert_first(&mut app, Some((alone, 9.5)));
        settle(&mut app);
        app.world_mut().get_mut::<Position>(alone).expect("a pose").0 = Vector::X * -1.0;
        assert_first(&mut app, Some((alone, 8.5)));
        app.world_mut().despawn(alone);
        assert_first(&mut app, Some((body, 14.5)));
        let parent = app.world_mut().spawn((RigidBody::Kinematic, at(-5.0))).id();
        let child = app.world_mut().spawn((cube(), at(1.0), ChildOf(parent))).id();
        assert_first(&mut app, Some((child, 5.5)));
        settle(&mut app);
        assert_first(&mut app, Some((child, 5.5)));
        app.world_mut().get_mut::<Position>(parent).expect("a pose").0 = Vector::X * -6.0;
        assert_first(&mut app, Some((child, 4.5)));
        settle(&mut app);
        app.world_mut().entity_mut(child).insert(CollisionLayers::new(0b10, LayerMask::ALL));
        let masked = ask(&mut app, |q| {
            q.cast_ray(Vector::X * -10.0, Dir::X, 100.0, true, &SpatialQueryFilter::from_mask(0b01))
        });
        assert_eq!(masked.map(|hit| hit.entity), Some(body));
        app.world_mut().despawn(parent);
        assert_first(&mut app, Some((body, 14.5)));
        app.world_mut().entity_mut(body).remove::<Collider>();
        assert_first(&mut app, None);
    }
}

/// A box, a capsule, a compound, or a shape that only parry has.
pub fn shape(kind: u8) -> Collider {
    let (a, b) = (Vector::X * 0.8, Vector::Y * 0.6);
    match kind % 4 {
        0 => cube(),
        1 => Collider::capsule(0.3, 0.9),
        2 => Collider::compound(vec![
            (a, Rotation::default(), cube()),
            (b, Rotation::default(), Collider::capsule(0.2, 0.5)),
        ]),
        _ => SharedShape::round_triangle(a, b, a * -0.5 - b, 0.2).into(),
    }
}

#[derive(Clone, Copy, Debug)]
enum Change {
    Step,
    Move(usize, [i8; 2]),
    Despawn(usize),
    Spawn(u8, [i8; 2]),
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        3 => Just(Change::Step),
        2 => (0..12usize, [-6..6i8, -6..6i8]).prop_map(|(which, place)| Change::Move(which, place)),
        1 => (0..12usize).prop_map(Change::Despawn),
        2 => (0..12u8, [-6..6i8, -6..6i8]).prop_map(|(kind, place)| Change::Spawn(kind, place)),
    ]
}

fn direction_of(along: Vector) -> Dir {
    Dir::new(avian::math::AsF32::f32(&along)).expect("a direction")
}

fn place([x, y]: [i8; 2]) -> Vector {
    Vector::X * Scalar::from(x) + Vector::Y * Scalar::from(y)
}

fn apply(app: &mut App, bodies: &mut Vec<Entity>, change: Change) {
    let which = |which: usize, bodies: &Vec<Entity>| (!bodies.is_empty()).then(|| which % bodies.len());
    match change {
        Change::Step => step(app),
        Change::Move(body, to) => {
            if let Some(body) = which(body, bodies) {
                app.world_mut().get_mut::<Position>(bodies[body]).expect("a pose").0 = place(to);
            }
        }
        Change::Despawn(body) => {
            if let Some(body) = which(body, bodies) {
                app.world_mut().despawn(bodies.swap_remove(body));
            }
        }
        Change::Spawn(kind, to) => {
            let body =
                [RigidBody::Static, RigidBody::Kinematic, RigidBody::Dynamic][usize::from(kind / 4) % 3];
            let turn = Rotation::from(bevy_math::Quat::from_rotation_z(f32::from(kind)));
            let velocity = LinearVelocity(Vector::X * 3.0 - place(to));
            bodies.push(app.world_mut().spawn((body, shape(kind), Position(place(to)), turn, velocity)).id());
        }
    }
}

/// All hits of a ray by looking at every collider, nearest first.
fn brute_ray(
    app: &App,
    bodies: &[Entity],
    origin: Vector,
    direction: Vector,
    solid: bool,
) -> Vec<(Entity, Scalar)> {
    let hit = |body: &Entity| {
        let entity = app.world().entity(*body);
        let position = *entity.get::<Position>().expect("a pose");
        let rotation = *entity.get::<Rotation>().expect("a pose");
        let collider = entity.get::<Collider>().expect("a shape");
        let hit = collider.cast_ray(position, rotation, origin, direction, 50.0, solid)?;
        Some((*body, hit.0))
    };
    let mut hits: Vec<_> = bodies.iter().filter_map(hit).collect();
    hits.sort_by(|a, b| a.1.total_cmp(&b.1));
    hits
}

/// The distance of a point from the boundary of a collider.
fn off_boundary(app: &App, collider: Entity, point: Vector) -> Scalar {
    let entity = app.world().entity(collider);
    let position = *entity.get::<Position>().expect("a pose");
    let rotation = *entity.get::<Rotation>().expect("a pose");
    let collider = entity.get::<Collider>().expect("a shape");
    collider.distance_to_point(position, rotation, point, false).abs()
}

/// The answers to one question each by all methods.
#[derive(Debug, PartialEq)]
struct Answers {
    first: Option<RayHitData>,
    all: Vec<RayHitData>,
    some: Vec<RayHitData>,
    called: Vec<RayHitData>,
    cast: Option<ShapeHitData>,
    casts: Vec<ShapeHitData>,
    nearest: Option<PointProjection>,
    at_point: Vec<Entity>,
    in_shape: Vec<Entity>,
}

fn answers(q: &SpatialQuery, origin: Vector, direction: Dir, solid: bool) -> Answers {
    let ball = shape(1);
    let turn = Default::default();
    let mut called = Vec::new();
    q.ray_hits_callback(origin, direction, 50.0, solid, &ALL, |hit| {
        called.push(hit);
        called.len() < 2
    });
    let config = ShapeCastConfig::from_max_distance(50.0);
    Answers {
        first: q.cast_ray(origin, direction, 50.0, solid, &ALL),
        all: q.ray_hits(origin, direction, 50.0, u32::MAX, solid, &ALL),
        some: q.ray_hits(origin, direction, 50.0, 2, solid, &ALL),
        called,
        cast: q.cast_shape(&ball, origin, turn, direction, &config, &ALL),
        casts: q.shape_hits(&ball, origin, turn, direction, u32::MAX, &config, &ALL),
        nearest: q.project_point(origin, solid, &ALL),
        at_point: q.point_intersections(origin, &ALL),
        in_shape: q.shape_intersections(&ball, origin, turn, &ALL),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// After any changes and steps, queries find what looking at the components of all colliders finds.
    #[test]
    fn queries_find_what_looking_at_all_components_finds(
        changes in prop::collection::vec(change(), 1..25), from in [-7..7i8, -7..7i8], angle in 0.0..6.25f32,
        solid in any::<bool>(),
    ) {
        let mut app = app();
        let mut bodies = Vec::new();
        let (sin, cos) = (angle.sin(), angle.cos());
        let along = Vector::X * Scalar::from(cos) + Vector::Y * Scalar::from(sin);
        let origin = place(from) + Vector::X * 0.013 + Vector::Y * 0.017;
        let direction = direction_of(along);
        for change in changes {
            apply(&mut app, &mut bodies, change);
            let a = ask(&mut app, move |q| answers(q, origin, direction, solid));
            let expected = brute_ray(&app, &bodies, origin, along, solid);
            // Parry hits what a ray passes by at some millimetres.
            let grazes = |entity: Entity| {
                let aside = Vector::X * Scalar::from(-sin) + Vector::Y * Scalar::from(cos);
                let hits = [-5.0e-3, 5.0e-3].map(|by| {
                    brute_ray(&app, &bodies, origin + aside * by, along, solid).iter().any(|hit| hit.0 == entity)
                });
                hits[0] != hits[1]
            };
            // Parry misses some hits. What it finds is found.
            for missed in expected.iter().filter(|(body, _)| a.all.iter().all(|hit| hit.entity != *body)) {
                prop_assert!(grazes(missed.0), "{missed:?} is not in {:?}", a.all);
            }
            for hit in &a.all {
                let collider = app.world().get::<Collider>(hit.entity).expect("a shape");
                // Of shapes that only parry has it answers both, from poses that differ in the last bit.
                let room = if collider.shape().as_round_triangle().is_some() { 1.0e-2 } else { 1.0e-4 };
                let other = expected.iter().find(|other| other.0 == hit.entity);
                if other.is_some_and(|other| (other.1 - hit.distance).abs() < room) {
                    continue;
                }
                // Parry's rays are less exact from inside and of compounds: the boundary tells.
                let off = off_boundary(&app, hit.entity, origin + along * hit.distance);
                prop_assert!(off < room, "off the boundary by {off}: {hit:?} and not {other:?}");
                prop_assert!(other.is_none_or(|other| hit.distance < other.1 + 1.0e-2), "{hit:?} after {other:?}");
            }
            // The methods agree with each other.
            prop_assert_eq!(a.first, a.all.first().copied());
            let few = a.all.iter().take(2).copied().collect::<Vec<_>>();
            prop_assert_eq!(&a.some, &few);
            prop_assert_eq!(&a.called, &few);
            prop_assert!(a.all.is_sorted_by(|a, b| a.distance <= b.distance));
            prop_assert_eq!(a.cast, a.casts.first().copied());
            prop_assert!(a.casts.is_sorted_by(|a, b| a.distance <= b.distance));
            // What a shape overlaps from the start it hits at once.
            for entity in &a.in_shape {
                prop_assert!(a.casts.iter().any(|hit| hit.entity == *entity && hit.distance < 1.0e-4));
            }
            prop_assert_eq!(a.nearest.is_none(), bodies.is_empty());
            if solid && let Some(entity) = a.at_point.first() {
                let nearest = a.nearest.expect("it is inside");
                prop_assert!(nearest.is_inside || nearest.point.distance(origin) < 1.0e-4, "{entity} {nearest:?}");
            }
        }
    }
}

/// Threads that share the parameter get the same answers as one.
#[test]
fn threads_share_a_query() {
    let mut app = app();
    for x in 0..20 {
        let body = if x % 2 == 0 { RigidBody::Static } else { RigidBody::Dynamic };
        app.world_mut().spawn((body, shape(x), at(f32::from(x) * 2.0)));
    }
    step(&mut app);
    app.world_mut().spawn((RigidBody::Static, cube(), at(-3.0)));
    ask(&mut app, |q| {
        let origins: Vec<Vector> =
            (0..40).map(|i| Vector::X * Scalar::from(i as u8) - Vector::Y * 0.1).collect();
        let one: Vec<_> = origins.iter().map(|o| answers(q, *o, Dir::X, true)).collect();
        let many: Vec<_> = std::thread::scope(|scope| {
            let threads: Vec<_> =
                origins.iter().map(|o| scope.spawn(move || answers(q, *o, Dir::X, true))).collect();
            threads.into_iter().map(|thread| thread.join().expect("no panic")).collect()
        });
        assert_eq!(one, many);
    });
}

fn hits(app: &App, caster: Entity) -> Vec<Entity> {
    app.world().get::<RayHits>(caster).expect("casters have hits").iter().map(|hit| hit.entity).collect()
}

#[test]
fn casters_follow_their_entity_and_ignore_all_of_their_own_body() {
    let mut app = app();
    app.insert_resource(Gravity::ZERO);
    let wall = app.world_mut().spawn((RigidBody::Static, cube(), at(10.0))).id();
    let ray = RayCaster::new(Vector::ZERO, Dir::X);
    let cast = ShapeCaster::new(Collider::capsule(0.1, 0.1), Vector::ZERO, Default::default(), Dir::X);
    let body = app.world_mut().spawn((RigidBody::Kinematic, cube(), at(0.0), ray.clone(), cast)).id();
    let arm = app.world_mut().spawn((cube(), at(2.0), ChildOf(body))).id();
    // Not a collider, and not at the body's place.
    let eye = app.world_mut().spawn((at(4.0), ray.clone(), ChildOf(body))).id();
    let seeing = ray.with_ignore_self(false);
    let other = app.world_mut().spawn((at(0.0), seeing.with_max_hits(2), ChildOf(arm))).id();
    step(&mut app);
    assert_eq!(hits(&app, body), [wall]);
    assert_eq!(hits(&app, eye), [wall]);
    assert_eq!(hits(&app, other), [arm, wall]);
    let shape_hits = app.world().get::<ShapeHits>(body).expect("hits").clone();
    assert_eq!(shape_hits.iter().map(|hit| hit.entity).collect::<Vec<_>>(), [wall]);
    let hit = shape_hits[0];
    assert!(
        (hit.distance - 9.4).abs() < 1.0e-4
            && (hit.point1.x - 9.5).abs() < 1.0e-4
            && (hit.point2 - hit.point1).length() < 1.0e-4,
        "{hit:?}"
    );
    assert!((hit.normal1 + Vector::X).length() < 1.0e-4 && (hit.normal2 - Vector::X).length() < 1.0e-4);

    // Moved and turned by half a turn, while physics is paused: the casters look the other way.
    app.world_mut().resource_mut::<Time<Physics>>().pause();
    let behind = app.world_mut().spawn((RigidBody::Static, cube(), at(-20.0))).id();
    let mut pose = app.world_mut().entity_mut(body);
    pose.get_mut::<Position>().expect("a pose").0 = Vector::X * 1.0;
    *pose.get_mut::<Rotation>().expect("a pose") =
        Rotation::from(bevy_math::Quat::from_rotation_z(core::f32::consts::PI));
    step(&mut app);
    assert_eq!(hits(&app, body), [behind]);
    assert_eq!(hits(&app, eye), [behind]);
    let caster = app.world().get::<RayCaster>(eye).expect("a caster");
    assert!((caster.global_origin() + Vector::X * 3.0).length() < 1.0e-4, "{}", caster.global_origin());
    assert!((caster.get_global_point(2.0) + Vector::X * 5.0).length() < 1.0e-4);

    app.world_mut().get_mut::<RayCaster>(eye).expect("a caster").disable();
    step(&mut app);
    assert!(hits(&app, eye).is_empty());
}

/// Numbers that are not finite, huge, and empty filters: no panic, and no hit that is not finite.
#[test]
fn no_input_makes_a_query_panic() {
    let mut app = app();
    app.insert_resource(Gravity::ZERO);
    for kind in 0..4 {
        app.world_mut().spawn((RigidBody::Static, shape(kind), at(f32::from(kind) * 2.0)));
    }
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y), Position(-Vector::Y * 2.0)));
    step(&mut app);
    let odd = [Scalar::NAN, Scalar::INFINITY, -Scalar::INFINITY, Scalar::MAX, -1.0, 0.0, 1.0e-40, 1.0e20];
    ask(&mut app, move |q| {
        let shapes = [shape(0), shape(3), Collider::half_space(Vector::Y), Collider::capsule(1.0e6, 1.0e6)];
        for a in odd {
            for b in odd {
                let point = Vector::X * a + Vector::Y * b;
                for direction in [Dir::X, Dir::NEG_Y] {
                    let finite = |hit: &RayHitData| hit.distance.is_finite() && hit.normal.is_finite();
                    assert!(q.ray_hits(point, direction, b, 9, true, &ALL).iter().all(finite));
                    q.cast_ray(Vector::ZERO, direction, a, false, &ALL);
                    let config =
                        ShapeCastConfig { max_distance: a, target_distance: b, ..ShapeCastConfig::DEFAULT };
                    for shape in &shapes {
                        let hits =
                            q.shape_hits(shape, point, Default::default(), direction, 9, &config, &ALL);
                        assert!(hits.iter().all(|hit| hit.distance.is_finite() && hit.normal1.is_finite()));
                        let from = Vector::Y * 3.0;
                        q.shape_hits(shape, from, Default::default(), direction, 9, &config, &ALL);
                    }
                }
                q.project_point(point, true, &ALL);
                q.project_point(point, false, &ALL);
                q.point_intersections(point, &ALL);
                q.aabb_intersections_with_aabb(ColliderAabb { min: point, max: Vector::ONE * b });
                for shape in &shapes {
                    q.shape_intersections(shape, point, Default::default(), &ALL);
                }
            }
        }
    });
}

#[test]
fn boxes_find_the_boxes_of_colliders() {
    let mut app = app();
    let first = app.world_mut().spawn((RigidBody::Static, cube(), at(0.0))).id();
    step(&mut app);
    let second = app.world_mut().spawn((RigidBody::Static, cube(), at(1.5))).id();
    let found = ask(&mut app, |q| {
        let aabb =
            |low: Scalar, high: Scalar| ColliderAabb { min: Vector::ONE * low, max: Vector::ONE * high };
        let mut called = Vec::new();
        q.aabb_intersections_with_aabb_callback(aabb(0.4, 0.95), |entity| {
            called.push(entity);
            false
        });
        (
            q.aabb_intersections_with_aabb(aabb(0.4, 0.95)),
            called,
            q.aabb_intersections_with_aabb(aabb(0.6, 0.9)),
        )
    });
    assert_eq!((&found.0[..], &found.1[..], &found.2[..]), (&[first][..], &[first][..], &[][..]));
    let wide = ask(&mut app, |q| {
        let aabb = ColliderAabb { min: -Vector::ONE, max: Vector::ONE * 2.0 };
        q.aabb_intersections_with_aabb(aabb)
    });
    assert_eq!(wide, [first, second]);
}

#[test]
fn defaults_are_avians() {
    let ray = RayCaster::default();
    assert!(ray.enabled && ray.solid && ray.ignore_self);
    assert_eq!((ray.max_hits, ray.max_distance, ray.direction), (u32::MAX, Scalar::MAX, Dir::X));
    let cast = ShapeCaster::default();
    assert!(cast.enabled && cast.ignore_self && cast.compute_contact_on_penetration);
    assert!(!cast.ignore_origin_penetration);
    assert_eq!((cast.max_hits, cast.max_distance, cast.target_distance), (1, Scalar::MAX, 0.0));
    assert_eq!(ShapeCastConfig::default(), ShapeCastConfig::DEFAULT);
    assert_eq!(SpatialQueryFilter::default(), SpatialQueryFilter::from_mask(LayerMask::ALL));
}

/// Casters with numbers that are not finite, without a place, or on what is despawned: no panic, and
/// others are updated.
#[test]
fn no_caster_disturbs_the_others() {
    let mut app = app();
    app.insert_resource(Gravity::ZERO);
    let wall = app.world_mut().spawn((RigidBody::Static, cube(), at(5.0))).id();
    let ray = RayCaster::new(Vector::ZERO, Dir::X);
    let cast = ShapeCaster::new(cube(), Vector::ZERO, Default::default(), Dir::X);
    let parent = app.world_mut().spawn(RigidBody::Kinematic).id();
    for odd in [Scalar::NAN, Scalar::INFINITY, -1.0, Scalar::MAX] {
        let moved = ray.clone().with_origin(Vector::X * odd).with_max_distance(odd);
        app.world_mut().spawn((moved.clone(), cast.clone().with_origin(Vector::Y * odd)));
        app.world_mut().spawn((moved, cast.clone().with_target_distance(odd), ChildOf(parent)));
        let far = cast.clone().with_max_distance(odd).with_max_hits(0);
        app.world_mut().spawn((ray.clone(), far, at(odd as f32)));
        app.world_mut().spawn((RigidBody::Kinematic, Position(Vector::Y * odd), cast.clone()));
    }
    let excluded = SpatialQueryFilter::from_excluded_entities([parent, wall]);
    let blind = app.world_mut().spawn(ray.clone().with_query_filter(excluded)).id();
    let good = app.world_mut().spawn(ray).id();
    step(&mut app);
    app.world_mut().despawn(parent);
    step(&mut app);
    assert_eq!(hits(&app, good), [wall]);
    assert!(hits(&app, blind).is_empty());
    let mut all = app.world_mut().query::<(&RayHits, Option<&ShapeHits>)>();
    for (rays, shapes) in all.iter(app.world()) {
        assert!(rays.iter().all(|hit| hit.distance.is_finite() && hit.normal.is_finite()));
        assert!(shapes.into_iter().flatten().all(|hit| hit.distance.is_finite() && hit.normal1.is_finite()));
    }
}

#[test]
fn many_queries_at_once_are_the_single_ones() {
    let mut app = app();
    for i in 0..40 {
        app.world_mut().spawn((
            RigidBody::Static,
            cube(),
            Transform::from_xyz(i as f32 * 1.7 - 30.0, (i % 5) as f32, 0.0),
        ));
    }
    step(&mut app);
    // One that the trees do not know yet.
    app.world_mut().spawn((cube(), at(3.3)));
    let same = ask(&mut app, |q| {
        let ball = Collider::capsule(0.3, 0.2);
        let way = |i: i32| Vector::X * ((i as Scalar * 0.731) % 70.0 - 35.0) + Vector::Y * 10.0;
        let rays: Vec<_> =
            (0..3_000).map(|i| (way(i), if i % 3 == 0 { Dir::Y } else { Dir::NEG_Y })).collect();
        let mut hits = vec![None; rays.len() + 5];
        q.cast_rays(&rays, 50.0, true, &ALL, &mut hits);
        let rays_agree =
            rays.iter().zip(&hits).all(|(ray, hit)| *hit == q.cast_ray(ray.0, ray.1, 50.0, true, &ALL));
        let rest_is_none = hits[rays.len()..].iter().all(Option::is_none);

        let casts: Vec<_> =
            rays.iter().map(|(at, direction)| (*at, Default::default(), *direction)).collect();
        let config = ShapeCastConfig::from_max_distance(50.0);
        let mut found = vec![None; 700];
        q.cast_shapes(&ball, &casts, &config, &ALL, &mut found);
        let casts_agree = casts
            .iter()
            .zip(&found)
            .all(|(cast, hit)| *hit == q.cast_shape(&ball, cast.0, cast.1, cast.2, &config, &ALL));

        let points: Vec<_> = rays.iter().map(|ray| ray.0).collect();
        let mut nearest = vec![None; points.len()];
        q.project_points(&points, true, &ALL, &mut nearest);
        let points_agree =
            points.iter().zip(&nearest).all(|(point, found)| *found == q.project_point(*point, true, &ALL));
        let any = hits.iter().flatten().count() > 100 && found.iter().flatten().count() > 100;
        [rays_agree, rest_is_none, casts_agree, points_agree, any]
    });
    assert_eq!(same, [true; 5]);
}
