//! The scale of transforms scales colliders.

mod exact_shapes;

use avian::{
    math::{Dir, Scalar, Vector},
    physics_transform::PhysicsTransformConfig,
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, system::RunSystemOnce};
use bevy_math::{Quat, Vec3};
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::{
    TransformPlugin,
    components::{GlobalTransform, Transform},
};
use core::time::Duration;
use proptest::prelude::*;

use super::scale_dim::{cuboid, lopsided, shapes, turn};

const DIM: usize = Vector::AXES.len();

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)))
        .insert_resource(Gravity::ZERO);
    app.finish();
    app.cleanup();
    app
}

fn step(app: &mut App) {
    app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / 64.0));
    app.update();
}

/// A vector with three components: 2D has `z` as the third.
fn vec3(v: Vector, z: f32) -> Vec3 {
    let mut all = [z; 3];
    all.iter_mut().zip(v.to_array()).for_each(|(to, from)| *to = from as f32);
    Vec3::from_array(all)
}

fn scaled(scale: Vector) -> Transform {
    Transform::from_scale(vec3(scale, 1.0))
}

fn at(place: Vector) -> Transform {
    Transform::from_translation(vec3(place, 0.0))
}

/// The factors 2, 3 and 4 along the axes.
fn uneven() -> Vector {
    Vector::from_array(core::array::from_fn(|i| 2.0 + i as Scalar))
}

/// All ways to mirror axes, and none.
fn mirrors() -> Vec<Vector> {
    let sign = |mirror: usize, axis: usize| if mirror >> axis & 1 == 1 { -1.0 } else { 1.0 };
    (0..1 << DIM).map(|mirror| Vector::from_array(core::array::from_fn(|axis| sign(mirror, axis)))).collect()
}

fn scale_of(app: &App, entity: Entity) -> Vector {
    app.world().get::<Collider>(entity).expect("a collider").scale()
}

#[track_caller]
fn assert_scale(app: &App, entity: Entity, expected: Vector) {
    let scale = scale_of(app, entity);
    assert!((scale - expected).length() <= 1.0e-5 * expected.length(), "{scale} and not {expected}");
}

fn set(app: &mut App, entity: Entity, transform: Transform) {
    *app.world_mut().get_mut::<Transform>(entity).expect("a transform") = transform;
}

/// Points all over a box with sides of 5 m.
fn points(count: u16) -> impl Iterator<Item = Vector> {
    (1..=count).map(|i| {
        let part = |axis: usize| Scalar::from(i) * [0.754_877_7, 0.569_840_3, 0.430_159_7][axis];
        Vector::from_array(core::array::from_fn(|axis| part(axis).fract() * 5.0 - 2.5))
    })
}

/// The distance from a collider at the origin. Negative inside of a solid one.
fn distance(collider: &Collider, point: Vector) -> Scalar {
    collider.distance_to_point(Vector::ZERO, Rotation::default(), point, false)
}

#[test]
fn colliders_have_the_scale_of_their_transforms_at_once_and_after_steps() {
    for scale in [Vector::ONE, Vector::splat(2.0), uneven(), -Vector::ONE, uneven() * mirrors()[1]] {
        let mut app = app();
        let world = app.world_mut();
        let body = world.spawn((RigidBody::Dynamic, lopsided(), scaled(scale))).id();
        let alone = world.spawn((lopsided(), scaled(scale))).id();
        let sensor = world.spawn((lopsided(), Sensor, scaled(scale))).id();
        let root = world.spawn(scaled(Vector::splat(0.5))).id();
        let held = world.spawn((lopsided(), scaled(scale), ChildOf(root))).id();
        let part = world.spawn((lopsided(), at(Vector::X), ChildOf(body))).id();
        let below = world.spawn((lopsided(), scaled(Vector::splat(3.0)), ChildOf(part))).id();
        for stepped in [false, true, true] {
            if stepped {
                step(&mut app);
            }
            assert_scale(&app, body, scale);
            assert_scale(&app, alone, scale);
            assert_scale(&app, sensor, scale);
            assert_scale(&app, held, scale * 0.5);
            for (entity, factor) in [(part, 1.0), (below, 3.0)] {
                // A mirror may be about another axis, with a turn for the rest.
                let (found, sign) = (scale_of(&app, entity), scale.to_array().iter().product::<Scalar>());
                assert!((found.abs() - scale.abs() * factor).length() < 1.0e-4, "{found}");
                assert!(found.to_array().iter().product::<Scalar>() * sign > 0.0, "{found}");
            }
        }
        let place = app.world().get::<ColliderTransform>(part).expect("its place on the body").translation;
        assert!((place - Vector::X * scale.x).length() < 1.0e-5, "{place}");
        let seen = app.world().get::<Position>(part).expect("a position").0;
        assert!((seen - Vector::X * scale.x).length() < 1.0e-5, "{seen}");
    }
}

#[test]
fn changes_are_followed_in_the_next_step() {
    let mut app = app();
    let world = app.world_mut();
    let root = world.spawn(Transform::default()).id();
    let other = world.spawn(scaled(Vector::splat(5.0))).id();
    let body = world.spawn((RigidBody::Dynamic, lopsided(), Transform::default(), ChildOf(root))).id();
    let part = world.spawn((lopsided(), scaled(Vector::splat(0.5)), ChildOf(body))).id();
    let alone = world.spawn((lopsided(), Transform::default(), ChildOf(root))).id();
    step(&mut app);
    set(&mut app, body, scaled(uneven()));
    step(&mut app);
    assert_scale(&app, body, uneven());
    assert_scale(&app, part, uneven() * 0.5);
    set(&mut app, root, scaled(Vector::splat(3.0)));
    step(&mut app);
    assert_scale(&app, body, uneven() * 3.0);
    assert_scale(&app, part, uneven() * 1.5);
    assert_scale(&app, alone, Vector::splat(3.0));
    app.world_mut().entity_mut(alone).insert(ChildOf(other));
    app.world_mut().entity_mut(body).insert(ChildOf(other));
    step(&mut app);
    assert_scale(&app, alone, Vector::splat(5.0));
    assert_scale(&app, body, uneven() * 5.0);
    assert_scale(&app, part, uneven() * 2.5);
    app.world_mut().entity_mut(alone).remove::<ChildOf>();
    app.world_mut().entity_mut(part).insert(ChildOf(other));
    step(&mut app);
    assert_scale(&app, alone, Vector::ONE);
    assert_scale(&app, part, Vector::splat(2.5));
}

#[test]
fn a_collider_attached_by_the_app_has_the_scale_of_its_own_transform() {
    let mut app = app();
    let body = app.world_mut().spawn((RigidBody::Dynamic, scaled(Vector::splat(7.0)))).id();
    let place = ColliderTransform { translation: Vector::X, ..Default::default() };
    let part = app.world_mut().spawn((lopsided(), scaled(uneven()), ColliderOf { body }, place)).id();
    step(&mut app);
    assert_scale(&app, part, uneven());
    let place = app.world().get::<ColliderTransform>(part).expect("its place on the body");
    assert_eq!((place.translation, place.scale), (Vector::X, uneven()));
}

#[test]
fn issue_471_a_replaced_collider_keeps_the_scale_of_the_transform() {
    let mut app = app();
    let bodies = [Some(RigidBody::Dynamic), Some(RigidBody::Static), None].map(|body| {
        let entity = app.world_mut().spawn((lopsided(), scaled(uneven()))).id();
        if let Some(body) = body {
            app.world_mut().entity_mut(entity).insert(body);
        }
        entity
    });
    step(&mut app);
    for body in bodies {
        app.world_mut().entity_mut(body).insert(cuboid(Vector::ONE));
        assert_scale(&app, body, uneven());
    }
    step(&mut app);
    for body in bodies {
        assert_scale(&app, body, uneven());
        let collider = app.world().get::<Collider>(body).expect("a collider");
        let corner = uneven() * 0.5;
        assert!(distance(collider, corner * 0.99) < 0.0 && distance(collider, corner * 1.01) > 0.0);
        // Mutated: by assignment, by a new shape, and by a scale.
        *app.world_mut().get_mut::<Collider>(body).expect("a collider") = lopsided();
    }
    step(&mut app);
    for body in bodies {
        assert_scale(&app, body, uneven());
        app.world_mut().get_mut::<Collider>(body).expect("a collider").set_scale(Vector::splat(9.0), 10);
    }
    step(&mut app);
    bodies.iter().for_each(|body| assert_scale(&app, *body, uneven()));
}

#[test]
fn the_setting_turns_it_off_and_on() {
    let mut app = app();
    app.world_mut().resource_mut::<PhysicsTransformConfig>().transform_to_collider_scale = false;
    let body = app.world_mut().spawn((RigidBody::Dynamic, lopsided(), scaled(uneven()))).id();
    let alone = app.world_mut().spawn((lopsided(), scaled(uneven()))).id();
    step(&mut app);
    assert_scale(&app, body, Vector::ONE);
    app.world_mut().get_mut::<Collider>(body).expect("a collider").set_scale(Vector::splat(9.0), 10);
    app.world_mut().entity_mut(alone).insert(cuboid(Vector::ONE));
    step(&mut app);
    assert_scale(&app, body, Vector::splat(9.0));
    assert_scale(&app, alone, Vector::ONE);
    app.world_mut().resource_mut::<PhysicsTransformConfig>().transform_to_collider_scale = true;
    step(&mut app);
    assert_scale(&app, body, uneven());
    assert_scale(&app, alone, uneven());
}

#[test]
fn without_the_plugin_of_transforms_colliders_keep_their_scale() {
    let mut app = App::new();
    let plugins = PhysicsPlugins::new(Update).build().disable::<PhysicsTransformPlugin>();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, plugins)).insert_resource(Gravity::ZERO);
    app.finish();
    app.cleanup();
    let start = (Position(Vector::ZERO), Rotation::default());
    let body = app.world_mut().spawn((RigidBody::Dynamic, lopsided(), scaled(uneven()), start)).id();
    step(&mut app);
    assert_scale(&app, body, Vector::ONE);
}

#[test]
fn a_scale_that_no_collider_has_leaves_the_last_good_one() {
    let bad = [0.0, -0.0, Scalar::NAN, Scalar::INFINITY, Scalar::NEG_INFINITY, 1.0e30, 1.0e-30];
    for bad in bad.into_iter().flat_map(|bad| [Vector::splat(bad), Vector::ONE.with_y(bad)]) {
        let mut app = app();
        let body = app.world_mut().spawn((RigidBody::Dynamic, lopsided(), scaled(uneven()))).id();
        let spoiled = app.world_mut().spawn((RigidBody::Dynamic, lopsided(), scaled(bad))).id();
        let alone = app.world_mut().spawn((lopsided(), scaled(uneven()))).id();
        step(&mut app);
        for entity in [body, alone] {
            set(&mut app, entity, scaled(bad));
        }
        for _ in 0..3 {
            step(&mut app);
        }
        assert_scale(&app, body, uneven());
        assert_scale(&app, alone, uneven());
        assert_scale(&app, spoiled, Vector::ONE);
        for entity in [body, alone, spoiled] {
            set(&mut app, entity, scaled(uneven() * 2.0));
        }
        step(&mut app);
        for entity in [body, alone, spoiled] {
            assert_scale(&app, entity, uneven() * 2.0);
        }
        assert!(app.world().get::<Position>(body).expect("a position").is_finite());
        assert!(app.world().get::<RigidBodyDisabled>(body).is_none());
    }
}

#[test]
fn a_scale_set_while_paused_is_seen_by_queries() {
    let mut app = app();
    let first = |app: &mut App| {
        let cast = |queries: SpatialQuery| {
            let all = SpatialQueryFilter::default();
            queries.cast_ray(Vector::X * -50.0, Dir::X, 100.0, true, &all).map(|hit| hit.distance)
        };
        app.world_mut().run_system_once(cast).expect("the system runs").expect("a hit")
    };
    for stepped in [false, true] {
        app.world_mut().resource_mut::<Time<Physics>>().unpause();
        let body = app.world_mut().spawn((RigidBody::Static, scaled(Vector::splat(2.0)))).id();
        let part = app.world_mut().spawn((cuboid(Vector::ONE), at(Vector::X), ChildOf(body))).id();
        if stepped {
            step(&mut app);
        }
        app.world_mut().resource_mut::<Time<Physics>>().pause();
        assert!((first(&mut app) - 51.0).abs() < 1.0e-4, "spawned with a scale: {}", first(&mut app));
        set(&mut app, body, scaled(Vector::splat(4.0)));
        step(&mut app);
        assert!((first(&mut app) - 52.0).abs() < 1.0e-4, "the body grew: {}", first(&mut app));
        set(&mut app, part, at(Vector::X).with_scale(Vec3::splat(2.0)));
        step(&mut app);
        assert!((first(&mut app) - 50.0).abs() < 1.0e-4, "the part grew: {}", first(&mut app));
        app.world_mut().despawn(body);
    }
}

/// Heights are closed forms: the top of the floor is at 10 · 0.5 m, the box is 2 · 0.5 m above it.
#[test]
fn a_scaled_box_rests_on_a_scaled_floor() {
    let mut app = app();
    app.insert_resource(Gravity(Vector::Y * -9.81));
    app.world_mut().spawn((RigidBody::Static, cuboid(Vector::ONE), scaled(Vector::splat(10.0))));
    let start = at(Vector::Y * 6.5).with_scale(Vec3::splat(2.0));
    let body = app.world_mut().spawn((RigidBody::Dynamic, cuboid(Vector::ONE), start)).id();
    let height = |app: &App| app.world().get::<Position>(body).expect("a position").y;
    for _ in 0..128 {
        step(&mut app);
    }
    assert!((height(&app) - 6.0).abs() < 0.02, "{}", height(&app));
    while app.world().get::<Sleeping>(body).is_none() {
        step(&mut app);
    }
    // A sleeping body that shrinks wakes and falls.
    let mut transform = app.world_mut().get_mut::<Transform>(body).expect("a transform");
    transform.scale = Vec3::ONE;
    step(&mut app);
    assert!(app.world().get::<Sleeping>(body).is_none(), "it sleeps on");
    for _ in 0..128 {
        step(&mut app);
    }
    assert!((height(&app) - 5.5).abs() < 0.02, "{}", height(&app));
    let transform = app.world().get::<Transform>(body).expect("a transform");
    assert_eq!(transform.scale, Vec3::ONE, "write-back keeps the scale");
}

#[test]
fn masses_are_density_times_scaled_volume() {
    let volume = |scale: Vector| scale.to_array().iter().product::<Scalar>().abs() as f32;
    let mut app = app();
    let dense = (RigidBody::Dynamic, cuboid(Vector::ONE), ColliderDensity(3.0));
    let body = app.world_mut().spawn((dense, scaled(uneven()))).id();
    let part = app.world_mut().spawn((cuboid(Vector::ONE), scaled(Vector::splat(2.0)), ChildOf(body))).id();
    let mass = |app: &App| app.world().get::<ComputedMass>(body).expect("a mass").value() as f32;
    let expected = |scale: Vector| volume(scale) * (3.0 + volume(Vector::splat(2.0)));
    step(&mut app);
    assert!((mass(&app) / expected(uneven()) - 1.0).abs() < 1.0e-4, "{}", mass(&app));
    for scale in mirrors().into_iter().map(|mirror| mirror * uneven() * 1.5) {
        set(&mut app, body, scaled(scale));
        step(&mut app);
        assert!((mass(&app) / expected(scale) - 1.0).abs() < 1.0e-4, "{}", mass(&app));
    }
    set(&mut app, part, scaled(Vector::splat(0.5)));
    set(&mut app, body, scaled(Vector::ONE));
    step(&mut app);
    assert!((mass(&app) / (3.0 + volume(Vector::splat(0.5))) - 1.0).abs() < 1.0e-4, "{}", mass(&app));
}

/// The tick at which the collider last changed.
fn changed(app: &App, entity: Entity) -> u32 {
    app.world().entity(entity).get_change_ticks::<Collider>().expect("a collider").changed.get()
}

#[test]
fn moving_and_turning_bodies_and_parents_do_not_rebuild_colliders() {
    let mut app = app();
    let spin = turn([0.1, 0.2, 0.3]);
    let motion = (LinearVelocity(Vector::X), Transform::from_scale(Vec3::splat(1.3)).with_rotation(spin));
    let body = app.world_mut().spawn((RigidBody::Dynamic, lopsided(), motion)).id();
    let part = app.world_mut().spawn((Collider::capsule(0.5, 1.0), at(Vector::X), ChildOf(body))).id();
    // A parent that the app turns, with an uneven scale above: noise in the scale of what is
    // turned by quarters.
    let root = app.world_mut().spawn(scaled(uneven() / 3.0)).id();
    let quarter = Transform::from_rotation(Quat::from_rotation_z(core::f32::consts::FRAC_PI_2));
    let held = app.world_mut().spawn((Collider::capsule(0.5, 1.0), quarter, ChildOf(root))).id();
    let turned = app.world_mut().spawn(Transform::from_scale(Vec3::splat(-0.7))).id();
    let ball = app.world_mut().spawn((Collider::capsule(0.5, 1.0), at(Vector::X), ChildOf(turned))).id();
    step(&mut app);
    let all = [body, part, held, ball];
    let before = all.map(|entity| changed(&app, entity));
    for i in 0..100 {
        let turn = turn([0.1, 0.07, 0.03].map(|rate| rate * i as f32));
        app.world_mut().get_mut::<Transform>(turned).expect("a transform").rotation = turn;
        app.world_mut().get_mut::<Transform>(root).expect("a transform").rotation = turn;
        step(&mut app);
    }
    assert_eq!(all.map(|entity| changed(&app, entity)), before);
    // Evenly scaled, a capsule is one still.
    let is_round =
        |entity| app.world().get::<Collider>(entity).expect("one").shape_scaled().as_capsule().is_some();
    assert!(is_round(part) && is_round(ball));
}

#[test]
fn an_eased_scale_is_that_of_the_last_tick() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(5)))
        .insert_resource(Gravity::ZERO);
    app.add_systems(FixedUpdate, |mut bodies: Query<&mut Transform, With<RigidBody>>| {
        bodies.iter_mut().for_each(|mut transform| transform.scale += 0.25);
    });
    app.finish();
    app.cleanup();
    let easing = (TransformInterpolation, ScaleInterpolation);
    let body = app.world_mut().spawn((RigidBody::Dynamic, lopsided(), Transform::default(), easing)).id();
    for _ in 0..40 {
        app.update();
        let scale = scale_of(&app, body).x;
        assert!((scale * 4.0).fract() < 1.0e-4, "{scale} is between two ticks");
    }
    assert!(scale_of(&app, body).x > 3.0);
}

/// A transform without shear: translation, turn, scale.
fn transform(scales: impl Strategy<Value = Vec3>) -> impl Strategy<Value = Transform> {
    let part = -1.0..1.0_f32;
    let place = [part.clone(), part.clone(), part]
        .prop_map(|[x, y, z]| Vec3::new(x, y, if DIM == 2 { 0.0 } else { z }));
    let angles = [-3.0..3.0_f32, -3.0..3.0_f32, -3.0..3.0_f32];
    (place, angles, scales).prop_map(|(translation, angles, scale)| Transform {
        translation,
        rotation: turn(angles),
        scale,
    })
}

fn factor() -> impl Strategy<Value = f32> {
    prop_oneof![0.4..2.0_f32, -2.0..-0.4_f32]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Even scales above and any scale below make no shear: the collider is the shape in its
    /// `GlobalTransform`.
    #[test]
    fn a_nested_collider_is_its_shape_in_the_global_transform(
        above in prop::collection::vec(transform(factor().prop_map(|f| if DIM == 2 { Vec3::new(f, f, f.abs()) } else { Vec3::splat(f) })), 0..4),
        own in transform([factor(), factor(), factor()].prop_map(|[x, y, z]| Vec3::new(x, y, if DIM == 2 { 1.0 } else { z }))),
        body in prop::option::of(0..4usize),
        late in any::<bool>(),
    ) {
        let mut app = app();
        let mut parent = None;
        let count = above.len();
        for (i, transform) in above.into_iter().chain([own]).enumerate() {
            let mut entity = app.world_mut().spawn(if late { Transform::default() } else { transform });
            if let Some(parent) = parent {
                entity.insert(ChildOf(parent));
            }
            if body.is_some_and(|body| body.min(count) == i) {
                entity.insert(RigidBody::Kinematic);
            }
            if i == count {
                entity.insert(lopsided());
            }
            let entity = entity.id();
            parent = Some(entity);
            if late {
                step(&mut app);
                set(&mut app, entity, transform);
            }
        }
        let entity = parent.expect("an entity");
        step(&mut app);
        step(&mut app);
        let global = *app.world().get::<GlobalTransform>(entity).expect("a transform");
        let seen = {
            let world = app.world();
            let collider = world.get::<Collider>(entity).expect("a collider");
            (collider.clone(), *world.get::<Position>(entity).expect("a position"), *world.get::<Rotation>(entity).expect("a rotation"))
        };
        let shape = lopsided();
        for point in points(120).map(|point| point * 0.5) {
            if distance(&shape, point).abs() < 5.0e-3 {
                continue;
            }
            let out = global.transform_point(vec3(point, 0.0)).to_array();
            let out = Vector::from_array(core::array::from_fn(|i| out[i] as Scalar));
            let expected = distance(&shape, point) < 0.0;
            prop_assert_eq!(seen.0.contains_point(seen.1, seen.2, out), expected, "{} at {}", point, out);
            let ask = move |queries: SpatialQuery| {
                queries.point_intersections(out, &SpatialQueryFilter::default()).contains(&entity)
            };
            prop_assert_eq!(app.world_mut().run_system_once(ask).expect("the system runs"), expected, "asked at {}", out);
        }
    }
}

/// The new shape woke the kinematic body, which came to rest again before its new pose was read.
#[test]
fn issue_a_kinematic_body_that_was_turned_and_scaled_at_once_was_not_turned() {
    for body in [RigidBody::Kinematic, RigidBody::Static, RigidBody::Dynamic] {
        let mut app = app();
        let body = app.world_mut().spawn((body, lopsided(), Transform::default())).id();
        step(&mut app);
        set(&mut app, body, scaled(uneven() * 0.2).with_rotation(turn([0.43, 0.2, 0.3])));
        step(&mut app);
        let cast = |origin: Vector, queries: &SpatialQuery| {
            let direction = Dir::new(-origin).expect("a direction");
            queries
                .cast_ray(origin, direction, 9.0, true, &SpatialQueryFilter::default())
                .map(|hit| hit.distance)
        };
        let ask =
            move |queries: SpatialQuery| points(20).map(|point| cast(point, &queries)).collect::<Vec<_>>();
        let found = app.world_mut().run_system_once(ask).expect("the system runs");
        let body = app.world().entity(body);
        let collider = body.get::<Collider>().expect("a collider");
        let (at, turned) = (*body.get::<Position>().expect("one"), *body.get::<Rotation>().expect("one"));
        for (origin, found) in points(20).zip(found) {
            let hit = collider.cast_ray(at, turned, origin, -origin.normalize(), 9.0, true).map(|hit| hit.0);
            assert!(
                (hit.unwrap_or(99.0) - found.unwrap_or(99.0)).abs() < 1.0e-3,
                "{found:?} and not {hit:?}"
            );
        }
    }
}
