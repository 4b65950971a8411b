//! [`MoveAndSlide`]: walls, corners, seams, slopes, overlaps, and input that is none.

use super::{SKIN, app, ask, block, figures, fixed, floor, rates, some, toward, turned};
use avian::{
    character_controller::move_and_slide::{COS_5_DEGREES, DepenetrationConfig},
    math::*,
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use core::time::Duration;

const ALL: SpatialQueryFilter = SpatialQueryFilter::DEFAULT;

/// A hit as `on_hit` saw it.
#[derive(Clone, Copy, Debug)]
struct Seen {
    entity: Entity,
    normal: Vector,
    distance: Scalar,
    collision_distance: Scalar,
}

/// A shape that was moved tick by tick: its positions, its last velocity, and all hits.
#[derive(Clone, Debug)]
struct Walk {
    path: Vec<Vector>,
    velocity: Vector,
    hits: Vec<Seen>,
}

impl Walk {
    fn end(&self) -> Vector {
        *self.path.last().expect("it began somewhere")
    }
}

/// Moves a shape by the same velocity in each of `ticks` ticks of `rate` Hz.
fn walk(app: &mut App, shape: &Collider, from: Vector, velocity: Vector, (ticks, rate): (u32, u32)) -> Walk {
    walk_by(app, shape, from, (ticks, rate), move |_| velocity)
}

/// Moves a shape by velocities that follow from the last projected one.
fn walk_by(
    app: &mut App,
    shape: &Collider,
    from: Vector,
    (ticks, rate): (u32, u32),
    next: impl Fn(Vector) -> Vector + Send + Sync + 'static,
) -> Walk {
    let shape = shape.clone();
    ask(app, move |mover| {
        let mut walk = Walk { path: vec![from], velocity: Vector::ZERO, hits: Vec::new() };
        let dt = Duration::from_secs_f64(1.0 / f64::from(rate));
        let config = MoveAndSlideConfig::default();
        for _ in 0..ticks {
            let (at, velocity) = (walk.end(), next(walk.velocity));
            let turn = Rotation::IDENTITY.into();
            let moved = mover.move_and_slide(&shape, at, turn, velocity, dt, &config, &ALL, |hit| {
                let (entity, distance) = (hit.entity, hit.distance);
                let (normal, collision_distance) = (hit.normal.adjust_precision(), hit.collision_distance);
                walk.hits.push(Seen { entity, normal, distance, collision_distance });
                MoveAndSlideHitResponse::Accept
            });
            walk.path.push(moved.position);
            walk.velocity = moved.projected_velocity;
        }
        walk
    })
}

/// How near a shape is to the nearest collider, in metres.
fn gap(app: &mut App, shape: &Collider, at: Vector) -> Scalar {
    let shape = shape.clone();
    ask(app, move |mover| {
        let mut least = Scalar::INFINITY;
        mover.intersections(&shape, at, Rotation::IDENTITY.into(), 1.0, &ALL, |_, contact, _| {
            least = least.min(-contact.penetration);
            true
        });
        least
    })
}

#[track_caller]
fn assert_near(a: Vector, b: Vector, error: Scalar, what: impl core::fmt::Debug) {
    assert!((a - b).length() <= error, "{what:?}: {a} and not {b}");
}

#[test]
fn the_settings_are_those_of_avian() {
    let config = MoveAndSlideConfig::default();
    assert_eq!((config.move_and_slide_iterations, config.depenetration_iterations), (4, 16));
    assert_eq!((config.max_depenetration_error, config.penetration_rejection_threshold), (1.0e-4, 0.5));
    assert_eq!((config.skin_width, config.max_planes), (SKIN, 20));
    assert_eq!(config.plane_similarity_dot_threshold, COS_5_DEGREES);
    assert!(config.planes.is_empty() && (COS_5_DEGREES - (5.0 as Scalar).to_radians().cos()).abs() < 1.0e-7);
    assert_eq!(DepenetrationConfig::default(), DepenetrationConfig::from(&config));
}

/// The walls stand at angles, too.
#[test]
fn a_wall_takes_what_goes_into_it_and_no_more() {
    for (name, shape) in figures() {
        for (tilt, rate) in [(0.0, 60), (0.3, 30), (-0.7, 144), (1.1, 360)] {
            let mut app = app();
            let along = toward(core::f32::consts::FRAC_PI_2 + tilt as f32);
            let into = toward(tilt as f32);
            fixed(&mut app, block(Vector::ONE * 100.0), into * 52.0, turned(tilt));
            for degrees in [10.0, 45.0, 80.0, 89.0] {
                let angle = (degrees as Scalar).to_radians();
                let velocity = (into * angle.cos() + along * angle.sin()) * 4.0;
                let start = walk(&mut app, &shape, Vector::ZERO, into * 4.0, (rate, rate)).end();
                let walk = walk(&mut app, &shape, start, velocity, (2 * rate, rate));
                let what = (name, tilt, rate, degrees);
                assert_near(walk.velocity, along * velocity.dot(along), 1.0e-4, what);
                let way = (walk.end() - start).dot(along);
                assert!((way - 8.0 * angle.sin()).abs() < 1.0e-4, "{what:?}: {way}");
                let gap = gap(&mut app, &shape, walk.end());
                assert!((gap - SKIN).abs() < 1.1e-4, "{what:?}: {gap}");
                assert!(walk.hits.iter().all(|hit| hit.normal.dot(into) < -0.999_999), "{what:?}");
            }
        }
    }
}

#[test]
fn inner_corners_stop_without_shaking() {
    for (name, shape) in figures() {
        for degrees in [30.0, 60.0, 75.0, 90.0, 120.0, 150.0_f32] {
            for &rate in rates(name) {
                let mut app = app();
                let half = degrees.to_radians() / 2.0;
                for side in [-1.0, 1.0] {
                    // The walls meet in the origin and open along -x.
                    let normal = toward(core::f32::consts::PI - side * (core::f32::consts::FRAC_PI_2 - half));
                    let turn = turned(side as Scalar * half.adjust_precision());
                    fixed(&mut app, block(Vector::ONE * 200.0), normal * -100.0, turn);
                }
                let velocity = Vector::X * 5.0 + Vector::Y * 0.7;
                let walk = walk(&mut app, &shape, Vector::X * -6.0, velocity, (4 * rate, rate));
                let late = &walk.path[walk.path.len() * 3 / 4..];
                let end = walk.end();
                let worst = late.iter().fold(0.0, |far: Scalar, p| far.max((*p - end).length()));
                let what = (name, degrees, rate);
                // Along an obtuse corner it may still slide, where a wall leads on.
                assert!(worst < 1.0e-4, "{what:?}: shakes by {worst} m");
                let gap = gap(&mut app, &shape, end);
                assert!((gap - SKIN).abs() < 2.0e-4, "{what:?}: {gap}");
            }
        }
    }
}

/// Falling and walking at once, on tiles, against one floor.
#[test]
fn seams_of_floors_are_not_met() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            let ends = [0.0, 0.5, 0.33].map(|size| {
                let mut app = app();
                if size == 0.0 {
                    floor(&mut app);
                } else {
                    for i in -4..(16.0 / size) as i32 {
                        let at = Vector::X * (size * i as Scalar) - Vector::Y * 0.5;
                        fixed(
                            &mut app,
                            block(Vector::ONE * 20.0 + Vector::X * (size - 20.0) - Vector::Y * 19.0),
                            at,
                            Rotation::IDENTITY,
                        );
                    }
                }
                let from = Vector::Y * (0.9 + SKIN);
                let walk = walk(&mut app, &shape, from, Vector::X * 5.0 - Vector::Y, (2 * rate, rate));
                let odd = walk.hits.iter().find(|hit| hit.normal.dot(Vector::Y) < 0.999_99);
                assert!(odd.is_none(), "{name}, tiles of {size} at {rate}: {odd:?}");
                let low = walk.path.iter().fold(0.0, |off: Scalar, p| off.max((p.y - 0.9 - SKIN).abs()));
                assert!(low < 1.0e-4, "{name}, tiles of {size} at {rate}: {low} off the floor");
                walk.end()
            });
            for end in ends {
                assert_near(end, ends[0], 1.0e-4, (name, rate));
                assert!((end.x - 10.0).abs() < 1.0e-4, "{name} at {rate}: {end}");
            }
        }
    }
}

/// Walls of tiles beside a floor of tiles: neither brakes, nor lifts.
#[test]
fn seams_of_walls_are_not_met() {
    for (name, shape) in figures() {
        for &rate in some(&[30, 64, 144]) {
            let mut app = app();
            for i in -4..30 {
                let at = Vector::Y * (0.4 * i as Scalar) + Vector::X * 1.0;
                fixed(
                    &mut app,
                    block(Vector::ONE * 0.4 + (Vector::ONE - Vector::X - Vector::Y) * 9.0),
                    at,
                    Rotation::IDENTITY,
                );
            }
            let velocity = Vector::X * 1.0 + Vector::Y * 4.0;
            let walk = walk(&mut app, &shape, Vector::ZERO, velocity, (2 * rate, rate));
            assert!((walk.end().y - 8.0).abs() < 1.0e-4, "{name} at {rate}: {}", walk.end());
            let odd = walk.hits.iter().find(|hit| hit.normal.x > -0.999_99);
            assert!(odd.is_none(), "{name} at {rate}: {odd:?}");
        }
    }
}

/// Up and down, along a slope, with the speed of the projected velocity.
#[test]
fn slopes_lead_on_exactly() {
    for (name, shape) in figures() {
        for degrees in [5, 25, 45, 65, 85] {
            for &rate in rates(name) {
                let angle = (degrees as Scalar).to_radians();
                let mut app = app();
                let (along, out) =
                    (toward(angle as f32), toward(angle as f32 + core::f32::consts::FRAC_PI_2));
                fixed(&mut app, block(Vector::ONE * 100.0), out * -52.0, turned(angle));
                let settle = walk(&mut app, &shape, Vector::Y * 0.5, -out * 60.0, (30, 30)).end();
                for pull in [1.0, -1.0] {
                    let velocity = along * (2.0 * pull) - out * 3.0;
                    let walk = walk(&mut app, &shape, settle, velocity, (rate, rate));
                    let expected = settle + along * (2.0 * pull);
                    assert_near(walk.end(), expected, 1.0e-4, (name, degrees, rate, pull));
                }
                // What pushes straight in does not drift.
                let stays = walk(&mut app, &shape, settle, -out * 3.0, (10 * rate, rate));
                assert_near(stays.end(), settle, 1.0e-5, (name, degrees, rate));
            }
        }
    }
}

/// Gravity that adds up, as a character has it.
#[test]
fn what_stands_does_not_move() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            let mut app = app();
            floor(&mut app);
            let down = Vector::NEG_Y * (9.81 / rate as Scalar);
            let walk = walk_by(&mut app, &shape, Vector::Y * 1.5, (4 * rate, rate), move |v| v + down);
            let late = &walk.path[walk.path.len() / 2..];
            assert!(late.iter().all(|p| (*p - walk.end()).length() < 1.0e-6), "{name} at {rate}: {late:?}");
            assert!((walk.end().y - 0.9 - SKIN).abs() < 1.1e-4, "{name} at {rate}: {}", walk.end());
            let touched = walk.hits.len();
            assert!(touched as u32 > 2 * rate, "{name} at {rate}: on the floor {touched} times");
        }
    }
}

/// A corner of a box under the middle of a shape, met exactly; beside the middle, it is passed on
/// its own side.
#[test]
fn corners_of_boxes_are_met_where_they_are() {
    for (name, shape) in figures() {
        let mut app = app();
        // A square that stands on its edge, with the tip in the origin.
        let half_turn = PI / 4.0;
        fixed(&mut app, block(Vector::ONE * 2.0), Vector::NEG_Y * (2.0 as Scalar).sqrt(), turned(half_turn));
        let down = walk(&mut app, &shape, Vector::Y * 2.0, Vector::NEG_Y * 3.0, (60, 60));
        assert_near(down.end(), Vector::Y * (0.9 + SKIN), 1.0e-4, name);
        let beside = walk(&mut app, &shape, Vector::Y * 2.0 + Vector::X * 0.3, Vector::NEG_Y * 3.0, (30, 60));
        let expected = if name == "capsule" { 0.3 } else { 0.0 };
        assert!(beside.end().x > 0.3 - 1.0e-4 && beside.end().x >= expected, "{name}: {}", beside.end());
    }
}

#[test]
fn each_plane_is_reported_with_its_collider() {
    for (name, shape) in figures() {
        let mut app = app();
        let floor = floor(&mut app);
        let wall = fixed(&mut app, block(Vector::ONE * 10.0), Vector::X * 6.0, Rotation::IDENTITY);
        let from = Vector::Y * (0.9 + SKIN);
        let velocity = Vector::X * 4.0 - Vector::Y;
        let walk = walk(&mut app, &shape, from, velocity, (60, 60));
        for hit in &walk.hits {
            let expected = if hit.entity == wall { Vector::NEG_X } else { Vector::Y };
            assert!(hit.entity == wall || hit.entity == floor);
            assert_near(hit.normal, expected, 1.0e-4, (name, hit));
            assert!(hit.collision_distance > hit.distance && hit.distance >= 0.0, "{name}: {hit:?}");
        }
        for entity in [floor, wall] {
            assert!(walk.hits.iter().any(|hit| hit.entity == entity), "{name}");
        }
        assert_near(walk.end(), Vector::X * (0.6 - SKIN) + from, 1.1e-4, name);
    }
}

#[test]
fn overlaps_are_left_by_the_shortest_way() {
    for (name, shape) in figures() {
        let mut app = app();
        for i in -8..8 {
            let at = Vector::X * (0.5 * i as Scalar) - Vector::Y * 1.0;
            fixed(
                &mut app,
                block(Vector::ONE * 20.0 - Vector::X * 19.5 - Vector::Y * 18.0),
                at,
                Rotation::IDENTITY,
            );
        }
        fixed(&mut app, block(Vector::ONE * 4.0), Vector::X * 3.0 + Vector::Y * 1.5, Rotation::IDENTITY);
        let shape = shape.clone();
        let cases = [
            (Vector::Y * 0.85, Vector::Y * (0.9 + SKIN)),
            (Vector::Y * 0.6 - Vector::X * 0.3, Vector::Y * (0.9 + SKIN) - Vector::X * 0.3),
            ((Vector::X * (0.75) + Vector::Y * (0.8)), (Vector::X * (0.6 - SKIN) + Vector::Y * (0.9 + SKIN))),
            (Vector::Y * 0.95, Vector::Y * 0.95),
        ];
        let ways = ask(&mut app, move |mover| {
            let config = DepenetrationConfig::default();
            cases.map(|(at, _)| mover.depenetrate(&shape, at, Rotation::IDENTITY.into(), &config, &ALL))
        });
        for ((at, expected), way) in cases.into_iter().zip(ways) {
            assert_near(at + way, expected, 2.0e-4, (name, at));
        }
    }
}

/// Deeper than is solved.
#[test]
fn what_is_deep_inside_stays() {
    for (name, shape) in figures() {
        let mut app = app();
        floor(&mut app);
        let walk = walk(&mut app, &shape, Vector::NEG_Y * 3.0, Vector::X, (60, 60));
        assert!(walk.end().is_finite() && (walk.end().y + 3.0).abs() < 1.0e-3, "{name}: {}", walk.end());
    }
}

/// Between walls that leave no room it is in the middle, and stays there.
#[test]
fn what_has_no_room_is_in_the_middle() {
    for (name, shape) in figures() {
        let mut app = app();
        for side in [-1.0, 1.0] {
            fixed(&mut app, block(Vector::ONE * 4.0), Vector::X * (side * 2.35), Rotation::IDENTITY);
        }
        let walk = walk(&mut app, &shape, Vector::X * 0.02, Vector::Y * 0.5, (60, 60));
        assert!(walk.path[1..].iter().all(|p| p.x.abs() < 1.0e-3), "{name}: {:?}", walk.path);
        assert!((walk.end().y - 0.5).abs() < 1.0e-3, "{name}: it moves along: {}", walk.end());
    }
}

#[test]
fn hits_can_be_ignored_or_end_the_move() {
    use MoveAndSlideHitResponse::{Abort, Accept, Ignore};
    for (name, shape) in figures() {
        for (response, end) in [(Accept, 0.6 - SKIN), (Abort, 0.6 - SKIN), (Ignore, 8.0)] {
            let mut app = app();
            fixed(&mut app, block(Vector::ONE * 4.0), Vector::X * 3.0, Rotation::IDENTITY);
            let shape = shape.clone();
            let (moved, hits) = ask(&mut app, move |mover| {
                let (turn, config) = (Rotation::IDENTITY.into(), MoveAndSlideConfig::default());
                let (from, dt) = (Vector::ZERO, Duration::from_secs(1));
                let mut hits = 0;
                let moved =
                    mover.move_and_slide(&shape, from, turn, Vector::X * 8.0, dt, &config, &ALL, |_| {
                        hits += 1;
                        response
                    });
                (moved, hits)
            });
            assert!((moved.position.x - end).abs() < 1.1e-4, "{name}, {response:?}: {moved:?}");
            let speed = if response == Accept { 0.0 } else { 8.0 };
            assert_near(moved.projected_velocity, Vector::X * speed, 1.0e-4, (name, response));
            assert_eq!(hits, 1, "{name}, {response:?}");
        }
    }
}

#[test]
fn sensors_and_what_is_gone_are_passed_by() {
    let mut app = app();
    let sensor = fixed(&mut app, block(Vector::ONE), Vector::X * 2.0, Rotation::IDENTITY);
    let gone = fixed(&mut app, block(Vector::ONE), Vector::X * 4.0, Rotation::IDENTITY);
    let off = fixed(&mut app, block(Vector::ONE), Vector::X * 6.0, Rotation::IDENTITY);
    let world = app.world_mut();
    world.entity_mut(sensor).insert(Sensor);
    world.entity_mut(off).insert(ColliderDisabled);
    world.despawn(gone);
    let shape = Collider::capsule(0.4, 1.0);
    let walked = walk(&mut app, &shape, Vector::ZERO, Vector::X * 8.0, (60, 60));
    assert_near(walked.end(), Vector::X * 8.0, 1.0e-5, "nothing is in the way");
    assert!(walked.hits.is_empty());
    // Nothing at all.
    let mut empty = super::app();
    let walked = walk(&mut empty, &shape, Vector::ZERO, Vector::X * 8.0, (60, 60));
    assert_near(walked.end(), Vector::X * 8.0, 1.0e-5, "an empty world");
}

#[test]
fn input_that_is_none_moves_nothing() {
    let mut app = app();
    fixed(&mut app, block(Vector::ONE * 4.0), Vector::NEG_Y * 3.0, Rotation::IDENTITY);
    let results = ask(&mut app, |mover| {
        let shape = Collider::capsule(0.4, 1.0);
        let (turn, config) = (Rotation::IDENTITY.into(), MoveAndSlideConfig::default());
        let go = |from, velocity, dt, config: &MoveAndSlideConfig| {
            mover.move_and_slide(&shape, from, turn, velocity, dt, config, &ALL, |_| Default::default())
        };
        let second = Duration::from_secs(1);
        let nan = Vector::splat(Scalar::NAN);
        let infinite = Vector::splat(Scalar::INFINITY);
        for velocity in [nan, infinite] {
            let moved = go(Vector::ZERO, velocity, second, &config);
            assert_eq!((moved.position, moved.projected_velocity), (Vector::ZERO, Vector::ZERO));
            assert!(mover.cast_move(&shape, Vector::ZERO, turn, velocity, SKIN, &ALL).is_none());
        }
        let moved = go(infinite, Vector::X, second, &config);
        assert_eq!((moved.position, moved.projected_velocity), (infinite, Vector::ZERO));
        assert_eq!(mover.depenetrate(&shape, nan, turn, &DepenetrationConfig::default(), &ALL), Vector::ZERO);
        let still = [
            go(Vector::ZERO, Vector::ZERO, second, &config),
            go(Vector::ZERO, Vector::X, Duration::ZERO, &config),
            go(
                Vector::ZERO,
                Vector::X,
                second,
                &MoveAndSlideConfig { move_and_slide_iterations: 0, ..config.clone() },
            ),
        ];
        // Settings out of range.
        for bad in [Scalar::NAN, -1.0, 0.0] {
            let config = MoveAndSlideConfig {
                skin_width: bad,
                max_depenetration_error: bad,
                penetration_rejection_threshold: bad,
                plane_similarity_dot_threshold: bad,
                ..config.clone()
            };
            let moved = go(Vector::Y * 2.0, Vector::NEG_Y * 5.0 + Vector::X, second, &config);
            assert!(moved.position.is_finite() && moved.position.y > -0.2, "{bad}: {moved:?}");
        }
        still
    });
    assert!(results.iter().all(|moved| moved.position == Vector::ZERO), "{results:?}");
}

#[test]
fn a_cast_ends_at_the_skin() {
    for (name, shape) in figures() {
        let mut app = app();
        let wall = fixed(&mut app, block(Vector::ONE * 4.0), Vector::X * 3.0, Rotation::IDENTITY);
        let check = shape.clone();
        let hits = ask(&mut app, move |mover| {
            let cast = |x: Scalar, movement| {
                mover.cast_move(&check, Vector::X * x, Rotation::IDENTITY.into(), movement, SKIN, &ALL)
            };
            [
                cast(0.0, Vector::X * 2.0),
                cast(0.0, (Vector::X + Vector::Y) * 2.0),
                cast(0.0, Vector::X * 0.5),
                cast(0.595, Vector::X),
                cast(0.7, Vector::X),
                cast(0.7, Vector::NEG_X),
            ]
        });
        let [ahead, askew, short, near, inside, out] = hits;
        let ahead = ahead.expect("a wall");
        assert_eq!((ahead.entity, ahead.intersects()), (wall, false));
        assert!((ahead.distance - 0.6 + SKIN).abs() < 1.0e-4, "{name}: {ahead:?}");
        assert!((ahead.collision_distance - 0.6).abs() < 1.0e-4, "{name}: {ahead:?}");
        assert_near(ahead.normal1, Vector::NEG_X, 1.0e-5, name);
        assert_near(ahead.normal2, Vector::X, 1.0e-5, name);
        assert!((ahead.point1.x - 1.0).abs() < 1.0e-4, "{name}: {ahead:?}");
        let root = (2.0 as Scalar).sqrt();
        let askew = askew.expect("a wall");
        assert!((askew.distance - (0.6 - SKIN) * root).abs() < 2.0e-4, "{name}: {askew:?}");
        assert!((askew.collision_distance - 0.6 * root).abs() < 2.0e-4, "{name}: {askew:?}");
        assert!(short.is_none(), "{name}: {short:?}");
        let near = near.expect("it is within the skin");
        assert!(near.distance == 0.0 && !near.intersects(), "{name}: {near:?}");
        assert!((near.collision_distance - 0.005).abs() < 1.0e-4, "{name}: {near:?}");
        assert!(inside.is_some_and(|hit| hit.intersects() && hit.distance == 0.0), "{name}: {inside:?}");
        assert!(out.is_none(), "{name}: {out:?}");
    }
}

/// Several colliders of one plane are one plane, and a plane of the app holds as one that was met.
#[test]
fn planes_of_the_app_hold() {
    let mut app = app();
    floor(&mut app);
    let moved = ask(&mut app, |mover| {
        let config = MoveAndSlideConfig { planes: vec![Dir::NEG_X], ..Default::default() };
        let velocity = Vector::X * 3.0 - Vector::Y;
        let (turn, from) = (Rotation::IDENTITY.into(), Vector::Y * 0.91);
        let shape = Collider::capsule(0.4, 1.0);
        let dt = Duration::from_millis(100);
        mover.move_and_slide(&shape, from, turn, velocity, dt, &config, &ALL, |_| Default::default())
    });
    assert_near(moved.projected_velocity, Vector::ZERO, 1.0e-5, "a wall of the app and a floor");
    assert_near(moved.position, Vector::Y * 0.91, 1.0e-4, "it stands");
    let way = ask(&mut app, |mover| {
        let config = DepenetrationConfig::default();
        mover.depenetrate_intersections(&config, &[(Dir::Y, 0.2), (Dir::X, 0.1), (Dir::Y, -1.0)])
    });
    assert_near(way, Vector::Y * 0.2 + Vector::X * 0.1, 1.0e-4, "two planes");
}
