//! What apps rely on in spatial queries.

use avian::{
    math::{Dir, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;

use super::queries::{ALL, app, ask, at, cube, shape, step};

/// Shapes of the kernel, a compound, and one that only parry has; from components and from the trees.
#[test]
fn a_ray_from_inside_of_a_solid_hits_at_once_without_a_normal() {
    for (kind, x) in [(0, 0.0), (1, 0.0), (2, 0.8), (3, 0.13)] {
        let mut app = app();
        let body = app.world_mut().spawn((RigidBody::Static, shape(kind), at(0.0))).id();
        for stepped in [false, true] {
            if stepped {
                step(&mut app);
            }
            let cast = move |q: &SpatialQuery, solid| q.cast_ray(Vector::X * x, Dir::X, 9.0, solid, &ALL);
            let [solid, hollow] = ask(&mut app, move |q| [cast(q, true), cast(q, false)]);
            let inside = RayHitData { entity: body, distance: 0.0, normal: Vector::ZERO };
            assert_eq!(solid, Some(inside), "shape {kind}, stepped: {stepped}");
            assert!(hollow.is_some_and(|hit| hit.distance > 0.0), "shape {kind}: {hollow:?}");
        }
    }
}

#[test]
fn hits_tell_their_points() {
    let mut app = app();
    let body = app.world_mut().spawn((RigidBody::Static, shape(1), at(3.0))).id();
    step(&mut app);
    let (origin, direction) =
        (Vector::Y * -1.2, Dir::new(Vector::X * 5.0 + Vector::Y * 2.0).expect("not zero"));
    let (ray, cast) = ask(&mut app, move |q| {
        let config = ShapeCastConfig::from_max_distance(50.0);
        let cast = q.cast_shape(&shape(1), origin, Default::default(), direction, &config, &ALL);
        (q.cast_ray(origin, direction, 50.0, true, &ALL), cast)
    });
    let (ray, cast) = (ray.expect("it is ahead"), cast.expect("it is ahead"));
    let off = |shape_at: Vector, point: Vector| {
        shape(1).distance_to_point(shape_at, Rotation::default(), point, false).abs()
    };
    let wall = app.world().get::<Position>(body).expect("a pose").0;
    assert!(off(wall, ray.point(origin, direction)) < 1.0e-4 && ray.distance > 1.0, "{ray:?}");
    let stop = cast.point(origin, direction);
    assert!(off(wall, cast.point1) < 1.0e-3 && off(stop, cast.point2) < 1.0e-3, "{cast:?} at {stop}");
    assert!(cast.point1.distance(cast.point2) < 1.0e-3);
}

#[test]
fn callbacks_stop_a_query_with_false() {
    let mut app = app();
    for x in [0.0, 0.1, 0.2] {
        app.world_mut().spawn((RigidBody::Static, cube(), at(x)));
    }
    step(&mut app);
    for most in [1, 2, 3] {
        let counts = ask(&mut app, move |q| {
            let (probe, turn, from) = (shape(1), Default::default(), Vector::X * -10.0);
            let config = ShapeCastConfig::from_max_distance(50.0);
            let mut counts = [0; 4];
            let [rays, casts, points, shapes] = &mut counts;
            let next = |count: &mut usize| {
                *count += 1;
                *count < most
            };
            q.ray_hits_callback(from, Dir::X, 50.0, true, &ALL, |_| next(rays));
            q.shape_hits_callback(&probe, from, turn, Dir::X, &config, &ALL, |_| next(casts));
            q.point_intersections_callback(Vector::ZERO, &ALL, |_| next(points));
            q.shape_intersections_callback(&probe, Vector::ZERO, turn, &ALL, |_| next(shapes));
            counts
        });
        assert_eq!(counts, [most; 4]);
    }
}

/// As character controllers do.
#[test]
fn a_system_asks_in_parallel_while_it_writes_transforms_and_forces() {
    fn look(queries: SpatialQuery, mut bodies: Query<(Entity, &Position, &mut Transform, Forces)>) {
        bodies.par_iter_mut().for_each(|(body, position, mut transform, mut forces)| {
            let filter = SpatialQueryFilter::from_excluded_entities([body]);
            let hit = queries.cast_ray(position.0, Dir::X, 9.0, true, &filter);
            transform.scale.x = 1.0;
            forces.apply_linear_impulse(Vector::X * hit.map_or(0.0, |hit| hit.distance));
        });
    }
    let mut app = app();
    app.insert_resource(Gravity::ZERO).add_systems(Update, look.before(PhysicsSystems::First));
    let left = app.world_mut().spawn((RigidBody::Dynamic, cube(), Mass(1.0), at(0.0))).id();
    app.world_mut().spawn((RigidBody::Static, cube(), at(5.0)));
    step(&mut app);
    let speed = app.world().get::<LinearVelocity>(left).expect("a body").x;
    assert!((speed - 4.5).abs() < 1.0e-3, "{speed}");
}
