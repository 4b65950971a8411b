//! Characters on floors, slopes and stairs.

use super::{Course, SKIN, all_at, block, each, figures, fixed, floor, some, terrain, toward, turned, usual};
use avian::{character_controller::controller::GroundState, math::*, prelude::*};

/// Half the height of the figures, with the skin: where one that stands on the floor is.
const STANDING: Scalar = 0.9 + SKIN;

/// The directions along a slope and out of it.
fn slope(angle: Scalar) -> [Vector; 2] {
    [toward(angle as f32), toward(angle as f32 + core::f32::consts::FRAC_PI_2)]
}

#[test]
fn a_jump_is_as_high_as_its_speed_says_at_any_rate() {
    for rate in usual() {
        let mut course = all_at(rate, Vector::Y * 2.0);
        floor(&mut course.app);
        let falls = course.walk_all(|_| Vector::ZERO, 0.7);
        course.jump(5.0);
        let jumps = course.walk_all(|_| Vector::X * 2.0, 1.2);
        for (i, (name, _)) in figures().iter().enumerate() {
            let what = (name, rate);
            let stood = falls[i].last().expect("it fell");
            assert!(stood.state.is_grounded(), "{what:?}: {stood:?}");
            assert!((stood.position.y - STANDING).abs() < 1.0e-4, "{what:?}: {stood:?}");
            let top = jumps[i].iter().fold(0.0, |top: Scalar, p| top.max(p.position.y)) - STANDING;
            // Half a tick at most beside the top of the parabola.
            let height = 25.0 / (2.0 * 9.81);
            let missed = 0.5 * 9.81 * (0.5 / rate as Scalar).powi(2);
            assert!(top < height + 1.0e-4 && top > height - missed - 1.0e-4, "{what:?}: {top} m");
            let in_air =
                jumps[i].iter().filter(|p| !p.state.is_grounded()).count() as Scalar / rate as Scalar;
            let expected = 2.0 * 5.0 / 9.81;
            assert!((in_air - expected).abs() < 1.5 / rate as Scalar, "{what:?}: {in_air} s");
            let end = jumps[i].last().expect("it jumped").position;
            // Of whole ticks.
            let way = 2.0 * jumps[i].len() as Scalar / rate as Scalar;
            assert!((end.x - way).abs() < 1.0e-3, "{what:?}: {end}");
            assert!((end.y - STANDING).abs() < 1.0e-4, "{what:?}: {end}");
        }
    }
}

#[test]
fn slopes_up_to_the_limit_are_walked_at_the_speed_asked_for() {
    let cases = each(&[5, 25, 45]);
    for rate in usual() {
        let starts = cases.iter().map(|(.., shape)| (shape.clone(), Vector::Y * 1.5));
        let mut course = Course::side_by_side(rate, starts);
        for (i, (_, degrees, _)) in cases.iter().enumerate() {
            let angle = (*degrees as Scalar).to_radians();
            let [_, out] = slope(angle);
            course.fix_in_lane(i, block(Vector::ONE * 100.0), out * -50.0, turned(angle));
        }
        let settled = course.walk_all(|_| Vector::ZERO, 0.6);
        let up = course.walk_all(|_| Vector::X * 3.0, 1.0);
        let down = course.walk_all(|_| Vector::X * -3.0, 1.0);
        let stood = course.walk_all(|_| Vector::ZERO, if rate == 64 { 10.0 } else { 1.0 });
        for (i, (name, degrees, _)) in cases.iter().enumerate() {
            let what = (name, degrees, rate);
            let [along, out] = slope((*degrees as Scalar).to_radians());
            let [before, top, start, end] =
                [&settled, &up, &down, &stood].map(|paths| *paths[i].last().expect("it walks"));
            assert!(before.state.is_grounded(), "{what:?}: {before:?}");
            for (from, to, pull) in [(before, top, 1.0), (top, start, -1.0)] {
                let expected = from.position + along * (3.0 * pull / along.x);
                let off = (to.position - expected).length();
                assert!(off < 2.0e-4, "{what:?}: off by {off}");
            }
            let lost = up[i].iter().chain(&down[i]).find(|p| !p.state.is_grounded());
            assert!(lost.is_none(), "{what:?}: {lost:?}");
            assert!((start.position - before.position).length() < 2.0e-4, "{what:?}");
            assert!((end.position - start.position).length() < 1.0e-5, "{what:?}: it drifts");
            assert!((end.state.ground_normal - out).length() < 1.0e-4, "{what:?}");
        }
    }
}

/// By g sin θ along the slope, frictionless.
#[test]
fn steep_slopes_are_slid_down() {
    let cases = each(&[55, 75, 85]);
    for rate in usual() {
        let starts = cases.iter().map(|(.., shape)| (shape.clone(), Vector::ZERO));
        let mut course = Course::side_by_side(rate, starts);
        for (i, (_, degrees, _)) in cases.iter().enumerate() {
            let angle = (*degrees as Scalar).to_radians();
            let [_, out] = slope(angle);
            // A little beside the corner of a box.
            let clearance = 0.42 * angle.sin() + 0.92 * angle.cos() + 0.02;
            course.fix_in_lane(i, block(Vector::ONE * 100.0), out * -(50.0 + clearance), turned(angle));
        }
        let paths = course.walk_all(|_| Vector::ZERO, 1.2);
        // Walking against it does not climb it.
        let up = course.walk_all(|_| Vector::X * 2.0, 0.5);
        for (i, (name, degrees, _)) in cases.iter().enumerate() {
            let what = (name, degrees, rate);
            let angle = (*degrees as Scalar).to_radians();
            let [along, _] = slope(angle);
            let last = paths[i].last().expect("it slides");
            let slid = paths[i].iter().find(|p| p.state.ground == GroundState::OnSteepGround);
            let slid = slid.unwrap_or_else(|| panic!("{what:?}: {last:?}"));
            assert_eq!(last.state.ground, GroundState::OnSteepGround, "{what:?}");
            let time = (last.tick - slid.tick) as Scalar / rate as Scalar;
            let (v0, v1) = (slid.state.fall.dot(-along), last.state.fall.dot(-along));
            let expected = 9.81 * angle.sin() * time;
            assert!((v1 - v0 - expected).abs() < 0.01 * expected, "{what:?}: {v0} to {v1} in {time} s");
            let end = up[i].last().expect("it slides on").position;
            assert!(end.y < last.position.y, "{what:?}: {end}");
        }
    }
}

#[test]
fn a_fast_walker_stays_on_a_slope_down() {
    for rate in usual() {
        let mut course = all_at(rate, Vector::Y * STANDING - Vector::X * 2.0);
        let level = Vector::NEG_X * 10.0 - Vector::Y * 10.0;
        fixed(&mut course.app, block(Vector::ONE * 20.0), level, Rotation::IDENTITY);
        // 45 degrees down from the origin.
        let (out, down) = (toward(PI as f32 / 4.0), toward(-PI as f32 / 4.0));
        fixed(&mut course.app, block(Vector::ONE * 60.0), (down - out) * 30.0, turned(PI / 4.0));
        course.walk(Vector::ZERO, 0.1);
        let paths = course.walk_all(|_| Vector::X * 10.0, 1.5);
        for ((name, _), path) in figures().iter().zip(paths) {
            let off = path.iter().find(|p| !p.state.is_grounded());
            assert!(off.is_none(), "{name} at {rate}: {off:?}");
            let end = path.last().expect("it walks").position;
            assert!((end.x - 13.0).abs() < 1.0e-3, "{name} at {rate}: {end}");
        }
    }
}

/// Ten steps of 0.3 m, 0.3 m deep, from 2 m on, in the lane of a character.
fn stairs(course: &mut Course, index: usize, is_mesh: bool) {
    if is_mesh {
        let mut corners = vec![Vector::X * -10.0, Vector::X * 2.0];
        for i in 0..10 {
            let (x, y) = (2.0 + 0.3 * i as Scalar, 0.3 * (i + 1) as Scalar);
            let depth = if i == 9 { 20.0 } else { 0.3 };
            corners.extend([Vector::X * x + Vector::Y * y, Vector::X * (x + depth) + Vector::Y * y]);
        }
        course.fix_in_lane(index, terrain(&corners), Vector::ZERO, Rotation::IDENTITY);
        return;
    }
    let base = block(Vector::ONE * 99.0 + Vector::X);
    course.fix_in_lane(index, base, Vector::NEG_Y * 49.5, Rotation::IDENTITY);
    for i in 0..10 {
        let height = 0.3 * (i + 1) as Scalar;
        let depth = if i == 9 { 20.0 } else { 0.3 };
        let size = Vector::ONE * 8.0 + Vector::X * (depth - 8.0) + Vector::Y * (height - 8.0);
        let at = Vector::X * (2.0 + 0.3 * i as Scalar + 0.5 * depth) + Vector::Y * (0.5 * height);
        course.fix_in_lane(index, block(size), at, Rotation::IDENTITY);
    }
}

/// As boxes and as a mesh.
#[test]
fn stairs_are_climbed_and_descended_at_any_rate() {
    for rate in usual() {
        let slow = if rate < 100 { 1.5 } else { 2.5 };
        let cases = each(&[(slow, false), (slow, true), (4.0, false), (4.0, true)]);
        let starts = cases.iter().map(|(.., shape)| (shape.clone(), Vector::Y * STANDING));
        let mut course = Course::side_by_side(rate, starts);
        for (i, (_, (_, is_mesh), _)) in cases.iter().enumerate() {
            stairs(&mut course, i, *is_mesh);
        }
        course.walk(Vector::ZERO, 0.1);
        let time = 6.0 / slow;
        let up = course.walk_all(|i| Vector::X * cases[i].1.0, time);
        let down = course.walk_all(|i| Vector::X * -cases[i].1.0, time * 1.2);
        for (i, (name, (speed, is_mesh), _)) in cases.iter().enumerate() {
            let what = (name, rate, speed, is_mesh);
            let off = up[i].iter().find(|p| !p.state.is_grounded());
            assert!(off.is_none(), "{what:?}: {off:?}");
            let falls = up[i].windows(2).find(|p| p[1].position.y < p[0].position.y - 1.0e-4);
            assert!(falls.is_none(), "{what:?}: {falls:?}");
            let end = up[i].last().expect("it walks").position;
            assert!((end.y - 3.0 - STANDING).abs() < 2.0e-4, "{what:?}: {end}");
            // On the flat it would come 6 m in this time.
            let end = up[i][(6.0 / speed * rate as Scalar) as usize - 1].position;
            assert!(end.x > 4.0, "{what:?}: too slow, at {end}");
            let climbed: Scalar = up[i].iter().map(|p| p.climbed).sum();
            assert!(climbed > 1.0, "{what:?}: {climbed} m climbed");
            let off = down[i].iter().find(|p| !p.state.is_grounded());
            assert!(off.is_none(), "{what:?}: down, {off:?}");
            let end = down[i].last().expect("it walks").position;
            assert!((end.y - STANDING).abs() < 2.0e-4, "{what:?}: down, {end}");
        }
    }
}

#[test]
fn what_is_too_high_or_has_no_room_is_no_step() {
    // Height and depth of a step with a wall behind it; whether it is climbed.
    let cases = each(&[(0.35, 1.0, true), (0.45, 1.0, false), (0.3, 0.05, false), (0.3, 0.2, true)]);
    for rate in usual() {
        let starts = cases.iter().map(|(.., shape)| (shape.clone(), Vector::Y * STANDING));
        let mut course = Course::side_by_side(rate, starts);
        floor(&mut course.app);
        for (i, (_, (height, depth, _), _)) in cases.iter().enumerate() {
            let step = block(Vector::ONE * 8.0 + Vector::Y * (height - 8.0));
            let at = Vector::X * 6.0 + Vector::Y * (0.5 * height);
            course.fix_in_lane(i, step, at, Rotation::IDENTITY);
            let wall = block(Vector::ONE * 8.0);
            course.fix_in_lane(i, wall, Vector::X * (6.0 + depth), Rotation::IDENTITY);
        }
        course.walk(Vector::ZERO, 0.1);
        let paths = course.walk_all(|_| Vector::X * 3.0, 1.2);
        for (i, (name, (height, depth, is_step), _)) in cases.iter().enumerate() {
            let what = (name, rate, height, depth);
            let rise = paths[i].last().expect("it walks").position.y - STANDING;
            if *is_step {
                assert!(rise > 0.1, "{what:?}: {rise}");
            } else {
                assert!(rise.abs() < 1.0e-3, "{what:?}: {rise}");
                assert!(paths[i].iter().all(|p| p.state.is_grounded()), "{what:?}");
            }
        }
    }
}

/// Neither brakes nor boosts, also below a ceiling.
#[test]
fn a_walk_along_a_wall_keeps_its_speed() {
    for &rate in some(&[30, 60, 240]) {
        let mut course = all_at(rate, Vector::Y * STANDING);
        let ceiling = Vector::Y * (1.8 + 3.0 * SKIN + 2.0);
        floor(&mut course.app);
        fixed(&mut course.app, block(Vector::ONE * 4.0 + Vector::X * 60.0), ceiling, Rotation::IDENTITY);
        let start = course.walk_all(|_| Vector::ZERO, 0.1);
        let paths = course.walk_all(|_| Vector::X * 5.0, 2.0);
        for (i, (name, _)) in figures().iter().enumerate() {
            let [from, to] = [&start, &paths].map(|paths| paths[i].last().expect("it walks").position);
            assert!((to.x - from.x - 10.0).abs() < 1.0e-3, "{name} at {rate}: {to}");
            assert!(paths[i].iter().all(|p| p.state.is_grounded()), "{name} at {rate}: under a ceiling");
        }
    }
}
