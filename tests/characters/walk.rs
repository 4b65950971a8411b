//! Characters on floors, slopes and stairs.

use super::{Course, SKIN, block, figures, fixed, floor, rates, toward, turned};
use avian::{character_controller::controller::GroundState, math::*, prelude::*};

/// Half the height of the figures, with the skin: where one that stands on the floor is.
const STANDING: Scalar = 0.9 + SKIN;

#[test]
fn a_jump_is_as_high_as_its_speed_says_at_any_rate() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            let mut course = Course::new(rate, shape.clone(), Vector::Y * 3.0);
            floor(&mut course.app);
            course.walk(Vector::ZERO, 1.5);
            let what = (name, rate);
            let state = course.state();
            assert!(state.is_grounded(), "{what:?}: {state:?}");
            assert!((course.position().y - STANDING).abs() < 1.0e-4, "{what:?}: {}", course.position());
            course.jump(5.0);
            let path = course.walk(Vector::X * 2.0, 1.5);
            let top = path.iter().fold(0.0, |top: Scalar, p| top.max(p.position.y)) - STANDING;
            // Half a tick at most beside the top of the parabola.
            let height = 25.0 / (2.0 * 9.81);
            let missed = 0.5 * 9.81 * (0.5 / rate as Scalar).powi(2);
            assert!(top < height + 1.0e-4 && top > height - missed - 1.0e-4, "{what:?}: {top} m");
            let in_air = path.iter().filter(|p| !p.state.is_grounded()).count() as Scalar / rate as Scalar;
            let expected = 2.0 * 5.0 / 9.81;
            assert!((in_air - expected).abs() < 1.5 / rate as Scalar, "{what:?}: {in_air} s");
            assert!((course.position().x - 3.0).abs() < 1.0e-3, "{what:?}: {}", course.position());
            assert!((course.position().y - STANDING).abs() < 1.0e-4, "{what:?}: {}", course.position());
        }
    }
}

#[test]
fn slopes_up_to_the_limit_are_walked_at_the_speed_asked_for() {
    for (name, shape) in figures() {
        for degrees in [5, 25, 45] {
            for &rate in rates(name) {
                let angle = (degrees as Scalar).to_radians();
                let (along, out) =
                    (toward(angle as f32), toward(angle as f32 + core::f32::consts::FRAC_PI_2));
                let mut course = Course::new(rate, shape.clone(), Vector::Y * 2.0);
                fixed(&mut course.app, block(Vector::ONE * 100.0), out * -52.0, turned(angle));
                course.walk(Vector::ZERO, 1.5);
                let what = (name, degrees, rate);
                let before = course.position();
                assert!(course.state().is_grounded(), "{what:?}: {:?}", course.state());
                for pull in [1.0, -1.0] {
                    let start = course.position();
                    let path = course.walk(Vector::X * (3.0 * pull), 1.0);
                    let expected = start + along * (3.0 * pull / along.x);
                    let off = (course.position() - expected).length();
                    assert!(off < 2.0e-4, "{what:?}: off by {off}");
                    assert!(path.iter().all(|p| p.state.is_grounded()), "{what:?}");
                }
                let start = course.position();
                assert!((start - before).length() < 2.0e-4, "{what:?}");
                course.walk(Vector::ZERO, if rate == 64 { 10.0 } else { 1.0 });
                assert!((course.position() - start).length() < 1.0e-5, "{what:?}: it drifts");
                assert!((course.state().ground_normal - out).length() < 1.0e-4, "{what:?}");
            }
        }
    }
}

/// By g sin θ along the slope, frictionless.
#[test]
fn steep_slopes_are_slid_down() {
    for (name, shape) in figures() {
        for degrees in [55, 75, 85] {
            for &rate in rates(name) {
                let angle = (degrees as Scalar).to_radians();
                let (along, out) =
                    (toward(angle as f32), toward(angle as f32 + core::f32::consts::FRAC_PI_2));
                let mut course = Course::new(rate, shape.clone(), Vector::ZERO);
                // A little beside the corner of a box.
                let clearance = 0.42 * angle.sin() + 0.92 * angle.cos() + 0.02;
                fixed(&mut course.app, block(Vector::ONE * 100.0), out * -(50.0 + clearance), turned(angle));
                let path = course.walk(Vector::ZERO, 1.2);
                let what = (name, degrees, rate);
                let slid = path.iter().find(|p| p.state.ground == GroundState::OnSteepGround);
                let slid = slid.unwrap_or_else(|| panic!("{what:?}: {:?}", course.state()));
                let last = path.last().expect("it slides");
                assert_eq!(last.state.ground, GroundState::OnSteepGround, "{what:?}");
                let time = (last.tick - slid.tick) as Scalar / rate as Scalar;
                let (v0, v1) = (slid.state.fall.dot(-along), last.state.fall.dot(-along));
                let expected = 9.81 * angle.sin() * time;
                assert!((v1 - v0 - expected).abs() < 0.01 * expected, "{what:?}: {v0} to {v1} in {time} s");
                // Walking against it does not climb it.
                let up = course.walk(Vector::X * 2.0, 0.5);
                assert!(up.last().unwrap().position.y < last.position.y, "{what:?}");
            }
        }
    }
}

#[test]
fn a_fast_walker_stays_on_a_slope_down() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            let mut course = Course::new(rate, shape.clone(), Vector::Y * 1.2 - Vector::X * 2.0);
            fixed(
                &mut course.app,
                block(Vector::ONE * 20.0),
                Vector::NEG_X * 10.0 - Vector::Y * 10.0,
                Rotation::IDENTITY,
            );
            // 45 degrees down from the origin.
            let (out, down) = (toward(PI as f32 / 4.0), toward(-PI as f32 / 4.0));
            fixed(&mut course.app, block(Vector::ONE * 60.0), (down - out) * 30.0, turned(PI / 4.0));
            course.walk(Vector::ZERO, 0.5);
            let path = course.walk(Vector::X * 10.0, 2.0);
            let off = path.iter().find(|p| !p.state.is_grounded());
            assert!(off.is_none(), "{name} at {rate}: {off:?}");
            assert!((course.position().x - 18.0).abs() < 1.0e-3, "{name} at {rate}: {}", course.position());
        }
    }
}

/// Ten steps of 0.3 m, 0.3 m deep; as boxes.
fn stairs(course: &mut Course) {
    floor(&mut course.app);
    for i in 0..10 {
        let height = 0.3 * (i + 1) as Scalar;
        let depth = if i == 9 { 8.0 } else { 0.3 };
        let size = Vector::ONE * 8.0 + Vector::X * (depth - 8.0) + Vector::Y * (height - 8.0);
        let at = Vector::X * (2.0 + 0.3 * i as Scalar + 0.5 * depth) + Vector::Y * (0.5 * height);
        fixed(&mut course.app, block(size), at, Rotation::IDENTITY);
    }
}

#[test]
fn stairs_are_climbed_and_descended_at_any_rate() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            for speed in if rate < 100 { [1.5, 4.0] } else { [2.5, 4.0] } {
                let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
                stairs(&mut course);
                course.walk(Vector::ZERO, 0.2);
                let what = (name, rate, speed);
                // On the flat it would take this long.
                let time = 6.0 / speed;
                let up = course.walk(Vector::X * speed, time);
                let off = up.iter().find(|p| !p.state.is_grounded());
                assert!(off.is_none(), "{what:?}: {off:?}");
                let falls = up.windows(2).find(|p| p[1].position.y < p[0].position.y - 1.0e-4);
                assert!(falls.is_none(), "{what:?}: {falls:?}");
                let end = course.position();
                assert!((end.y - 3.0 - STANDING).abs() < 2.0e-4, "{what:?}: {end}");
                assert!(end.x > 4.0, "{what:?}: too slow, at {end}");
                let climbed: Scalar = up.iter().map(|p| p.climbed).sum();
                assert!(climbed > 1.0, "{what:?}: {climbed} m climbed");
                let down = course.walk(Vector::NEG_X * speed, time * 1.2);
                let off = down.iter().find(|p| !p.state.is_grounded());
                assert!(off.is_none(), "{what:?}: down, {off:?}");
                let end = course.position();
                assert!((end.y - STANDING).abs() < 2.0e-4, "{what:?}: down, {end}");
            }
        }
    }
}

#[test]
fn what_is_too_high_or_has_no_room_is_no_step() {
    for (name, shape) in figures() {
        for rate in [30, 64, 360] {
            // Height and depth of a step with a wall behind it; whether it is climbed.
            for (height, depth, is_step) in
                [(0.35, 1.0, true), (0.45, 1.0, false), (0.3, 0.05, false), (0.3, 0.2, true)]
            {
                let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
                floor(&mut course.app);
                let size = Vector::ONE * 8.0 + Vector::Y * (height - 8.0);
                fixed(
                    &mut course.app,
                    block(size),
                    Vector::X * 6.0 + Vector::Y * (0.5 * height),
                    Rotation::IDENTITY,
                );
                fixed(
                    &mut course.app,
                    block(Vector::ONE * 8.0),
                    Vector::X * (6.0 + depth),
                    Rotation::IDENTITY,
                );
                course.walk(Vector::ZERO, 0.2);
                let path = course.walk(Vector::X * 3.0, 1.5);
                let rise = course.position().y - STANDING;
                let what = (name, rate, height, depth);
                if is_step {
                    assert!(rise > 0.1, "{what:?}: {rise}");
                } else {
                    assert!(rise.abs() < 1.0e-3, "{what:?}: {rise}");
                    assert!(path.iter().all(|p| p.state.is_grounded()), "{what:?}");
                }
            }
        }
    }
}

/// Neither brakes nor boosts, also along the side of stairs.
#[test]
fn a_walk_along_a_wall_keeps_its_speed() {
    for (name, shape) in figures() {
        for rate in [30, 60, 240] {
            let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
            let ceiling = Vector::Y * (1.8 + 3.0 * SKIN + 2.0);
            floor(&mut course.app);
            fixed(&mut course.app, block(Vector::ONE * 4.0 + Vector::X * 60.0), ceiling, Rotation::IDENTITY);
            course.walk(Vector::ZERO, 0.2);
            let start = course.position();
            let path = course.walk(Vector::X * 5.0, 2.0);
            assert!(
                (course.position().x - start.x - 10.0).abs() < 1.0e-3,
                "{name} at {rate}: {}",
                course.position()
            );
            assert!(path.iter().all(|p| p.state.is_grounded()), "{name} at {rate}: under a ceiling");
        }
    }
}
