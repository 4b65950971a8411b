//! Tight places: tubes that touch a character at each of their facets, and wedges of a floor and a ceiling.

use super::{Course, SKIN, block, figures, fixed, floor, groove, some, toward, turned, usual};
use avian::{math::*, prelude::*};

const STANDING: Scalar = 0.9 + SKIN;

/// Half of a tube of 768 facets, each at the distance of the skin: in space beside the character, in the
/// plane below it.
#[test]
fn a_groove_of_many_facets_holds_and_lets_go() {
    for &rate in some(&[30, 60]) {
        let mut course = Course::new(rate, Collider::capsule(0.4, 1.0), groove::START);
        if groove::IS_UPRIGHT {
            floor(&mut course.app);
        }
        let tube = groove::tube(0.4 + SKIN, 768);
        fixed(&mut course.app, tube, Vector::ZERO, Rotation::IDENTITY);
        course.walk(Vector::ZERO, 0.1);
        let start = course.position();
        assert!((start - groove::START).length() < 5.0e-4, "{rate}: {start}");
        for way in groove::INTO {
            for p in course.walk(way * 3.0, 0.1) {
                assert!((p.position - start).length() < 1.0e-3, "{rate}, {way}: {p:?}");
                assert!(p.state.is_grounded(), "{rate}, {way}: {p:?}");
            }
        }
        // Out of it at its own speed.
        let at = course.position();
        if groove::IS_UPRIGHT {
            let ticks = course.walk(Vector::NEG_X * 3.0, 0.2).len();
            let way = 3.0 * ticks as Scalar / rate as Scalar;
            assert!(
                (course.position() - at + Vector::X * way).length() < 2.0e-3,
                "{rate}: {}",
                course.position()
            );
        } else {
            course.jump(3.0);
            let top = course
                .walk(Vector::ZERO, 0.3)
                .iter()
                .fold(0.0, |top: Scalar, p| top.max(p.position.y - at.y));
            let missed = 0.5 * 9.81 * (0.5 / rate as Scalar).powi(2);
            let height = 9.0 / (2.0 * 9.81);
            assert!(top < height + 1.0e-3 && top > height - missed - 1.0e-3, "{rate}: {top}");
        }
    }
}

/// A floor and a ceiling that come nearer by 5 to 60 degrees hold what walks in, and let it out again.
#[test]
fn a_wedge_holds_and_lets_go() {
    let cases: Vec<_> = [5.0, 10.0, 20.0, 40.0, 60.0]
        .into_iter()
        .flat_map(|degrees: Scalar| figures().into_iter().map(move |(name, shape)| (degrees, name, shape)))
        .collect();
    for rate in usual() {
        let starts = cases.iter().map(|(_, _, shape)| (shape.clone(), Vector::Y * STANDING));
        let mut course = Course::side_by_side(rate, starts);
        floor(&mut course.app);
        let mut longest: Scalar = 0.0;
        for (i, (degrees, ..)) in cases.iter().enumerate() {
            // There is room of 2.1 m at the start.
            let angle = degrees.to_radians();
            let up = toward(core::f32::consts::FRAC_PI_2 - angle as f32);
            let end = Vector::X * (2.1 / angle.tan());
            course.fix_in_lane(i, block(Vector::ONE * 100.0), end + up * 50.0, turned(-angle));
            longest = longest.max(0.3 / angle.tan());
        }
        course.walk_all(|_| Vector::X * 3.0, longest / 3.0 + 0.2);
        let inside = course.walk_all(|_| Vector::X * 3.0, 0.5);
        let outside = course.walk_all(|_| Vector::NEG_X * 3.0, 0.5);
        for (i, (degrees, name, _)) in cases.iter().enumerate() {
            let what = (degrees, name, rate);
            let end = inside[i].last().expect("it walks").position;
            let shakes = inside[i].iter().map(|p| (p.position - end).length()).fold(0.0, Scalar::max);
            assert!(shakes < 1.0e-4, "{what:?}: shakes by {shakes} m");
            assert!(inside[i].iter().all(|p| p.state.is_grounded()), "{what:?}");
            let out = end.x - outside[i].last().expect("it walks").position.x;
            assert!((out - 1.5).abs() < 2.0e-3, "{what:?}: it comes out by {out} m");
        }
    }
}

/// A gap too narrow by 8 mm between a wall and one that leans away by 2 degrees: to fit, it would have to
/// rise by 23 cm.
#[test]
fn a_gap_between_walls_does_not_lift() {
    for rate in usual() {
        let starts = figures().into_iter().map(|(_, shape)| (shape, Vector::Y * STANDING));
        let mut course = Course::side_by_side(rate, starts);
        floor(&mut course.app);
        let lean = -0.035;
        for (i, (_, shape)) in figures().into_iter().enumerate() {
            let half = shape.aabb(Vector::ZERO, Rotation::IDENTITY).max.x + SKIN - 0.004;
            let wall = block(Vector::ONE * 4.0);
            course.fix_in_lane(i, wall.clone(), Vector::X * (-half - 2.0), turned(0.0));
            // Its side goes through the middle of the character's waist.
            let side = Vector::X * half + Vector::Y * 0.5;
            course.fix_in_lane(i, wall, side + turned(lean) * (Vector::X * 2.0), turned(lean));
        }
        for way in [Vector::ZERO, Vector::X * 3.0] {
            for p in course.walk_all(|_| way, 0.5).iter().flatten() {
                assert!(p.state.is_grounded() && (p.position.y - STANDING).abs() < 1.0e-3, "{rate}: {p:?}");
            }
        }
    }
}
