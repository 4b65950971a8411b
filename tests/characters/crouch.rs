//! Characters that crouch.

use super::{Course, SKIN, Sample, all_at, ask, block, crouched, figures, fixed, floor, usual};
use avian::{math::*, prelude::*};

/// Half the heights of the figures, with the skin.
const STANDING: Scalar = 0.9 + SKIN;
const LOW: Scalar = 0.5 + SKIN;

fn crouches(course: &mut Course, crouch: bool) {
    for &player in &course.players {
        course.app.world_mut().get_mut::<CharacterInput>(player).expect("a character").crouch = crouch;
    }
}

/// A tunnel 1.2 m high and 4 m long, from 2 m on, with all figures.
fn tunnel(rate: u32) -> Course {
    let mut course = all_at(rate, Vector::Y * STANDING);
    for (&player, (name, standing)) in course.players.iter().zip(figures()) {
        let crouch = CharacterCrouch { standing, crouching: crouched(name) };
        course.app.world_mut().entity_mut(player).insert(crouch);
    }
    floor(&mut course.app);
    let at = Vector::X * 4.0 + Vector::Y * 3.2;
    fixed(&mut course.app, block(Vector::ONE * 4.0), at, Rotation::IDENTITY);
    course.walk(Vector::ZERO, 0.1);
    course
}

#[test]
fn a_low_tunnel_is_for_those_that_crouch() {
    for rate in usual() {
        let mut course = tunnel(rate);
        let before = course.walk_all(|_| Vector::X * 3.0, 0.8);
        crouches(&mut course, true);
        let inside = course.walk_all(|_| Vector::X * 3.0, 0.6);
        // No room to stand up, until it is out.
        crouches(&mut course, false);
        let after = course.walk_all(|_| Vector::X * 3.0, 1.5);
        for (i, (name, _)) in figures().iter().enumerate() {
            let what = (name, rate);
            let end = before[i].last().expect("it walks").position;
            assert!((end.x - 1.6 + SKIN).abs() < 2.0e-3, "{what:?}: it stands before the tunnel, at {end}");
            let low = |p: &Sample| (p.position.y - LOW).abs() < 2.0e-4 && p.state.is_grounded();
            assert!(inside[i].iter().all(low), "{what:?}: {:?}", inside[i].iter().find(|p| !low(p)));
            let walked = inside[i].last().expect("it walks").position.x - end.x;
            assert!((walked - 1.8).abs() < 3.0 / rate as Scalar, "{what:?}: {walked}");
            for p in &after[i] {
                let is_out = p.position.x > 6.45;
                assert!(p.state.is_grounded(), "{what:?}: {p:?}");
                let expected = if p.state.is_crouching { LOW } else { STANDING };
                assert!((p.position.y - expected).abs() < 2.0e-4, "{what:?}: {p:?}");
                assert!(p.state.is_crouching || p.position.x > 6.3, "{what:?}: {p:?}");
                let late = p.position.x > 6.45 + 3.0 / rate as Scalar;
                assert!(!(is_out && late && p.state.is_crouching), "{what:?}: {p:?}");
            }
            let last = after[i].last().expect("it walks");
            assert!(!last.state.is_crouching && last.position.x > 7.0, "{what:?}: {last:?}");
        }
    }
}

/// Feet stay on a lift, and in the air.
#[test]
fn feet_stay_where_they_are() {
    let mut course = tunnel(60);
    let figures = figures();
    let lift = (RigidBody::Kinematic, block(Vector::ONE * 4.0), Position(Vector::X * -6.0));
    let lift = course.app.world_mut().spawn((lift, LinearVelocity(Vector::Y))).id();
    (0..figures.len()).for_each(|i| course.put(i, Vector::X * -6.0 + Vector::Y * (2.0 + STANDING)));
    course.walk(Vector::ZERO, 0.2);
    for i in 0..6 {
        crouches(&mut course, i % 2 == 0);
        for _ in 0..6 {
            for (sample, (name, _)) in course.tick_all().into_iter().zip(&figures) {
                let half = if i % 2 == 0 { 0.5 } else { 0.9 };
                let gap = sample.position.y - half - course.get::<Position>(lift).0.y - 2.0;
                assert!((gap - SKIN).abs() < 2.0e-4, "{name}, {i}: a gap of {gap}");
                assert!(sample.state.is_grounded(), "{name}: {sample:?}");
            }
        }
    }
    course.jump(5.0);
    let before = course.walk_all(|_| Vector::ZERO, 0.1);
    crouches(&mut course, true);
    for ((before, after), (name, _)) in before.iter().zip(course.tick_all()).zip(&figures) {
        let before = before.last().expect("it flies");
        let expected = before.position.y - 0.4 + (before.state.fall.y - 0.5 * 9.81 / 60.0) / 60.0;
        assert!((after.position.y - expected).abs() < 1.0e-4, "{name}: {after:?}, not {expected}");
        assert!(after.state.is_crouching);
    }
}

#[test]
fn room_for_a_shape_can_be_asked_for() {
    let mut course = tunnel(60);
    let players = course.players.clone();
    for (name, shape) in figures() {
        let low = crouched(name);
        for (x, shape, half, expected) in [
            (0.0, shape.clone(), STANDING, true),
            (4.0, shape.clone(), STANDING, false),
            (4.0, low.clone(), LOW, true),
            (4.0, low.clone(), LOW - 0.5 * SKIN, false),
            (Scalar::NAN, low.clone(), LOW, false),
        ] {
            let filter = SpatialQueryFilter::from_excluded_entities(players.clone());
            let at = Vector::X * x + Vector::Y * half;
            let fits = ask(&mut course.app, move |mover| {
                mover.fits(&shape, at, Rotation::IDENTITY.into(), SKIN, &filter)
            });
            assert_eq!(fits, expected, "{name} at {x}, {half}");
        }
    }
}
