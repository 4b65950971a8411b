//! Characters on what moves, and before what moves.

use super::{Course, SKIN, block, figures, fixed, floor, rates, spin};
use avian::{character_controller::controller::GroundState, math::*, prelude::*};
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;

const STANDING: Scalar = 0.9 + SKIN;

/// A kinematic body.
fn moving(course: &mut Course, shape: Collider, at: Vector, velocity: Vector) -> Entity {
    let bundle = (RigidBody::Kinematic, shape, Position(at), LinearVelocity(velocity));
    course.app.world_mut().spawn(bundle).id()
}

fn set<C: Component>(course: &mut Course, entity: Entity, value: C) {
    course.app.world_mut().entity_mut(entity).insert(value);
}

/// Up and down at 0.5 and 5 m/s, turning round at once.
#[test]
fn feet_stay_on_a_lift_that_turns_round() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            for speed in [0.5, 5.0] {
                let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
                let lift = moving(&mut course, block(Vector::ONE * 4.0), Vector::NEG_Y * 2.0, Vector::ZERO);
                course.walk(Vector::ZERO, 0.2);
                for turn in 0..6 {
                    let way = if turn % 2 == 0 { speed } else { -speed };
                    set(&mut course, lift, LinearVelocity(Vector::Y * way));
                    for _ in 0..rate / 3 {
                        let sample = course.tick();
                        let gap = sample.position.y - course.get::<Position>(lift).0.y - 2.0 - 0.9;
                        let what = (name, rate, speed, turn);
                        assert!((gap - SKIN).abs() < 2.0e-4, "{what:?}: a gap of {gap}");
                        assert!(sample.state.is_grounded(), "{what:?}: {:?}", sample.state);
                        assert!((sample.state.ground_velocity.y - way).abs() < 1.0e-5, "{what:?}");
                    }
                }
            }
        }
    }
}

/// By its transform, with turns at up to 7 m/s²; and a carousel.
#[test]
fn feet_stay_on_a_lift_that_follows_its_transform() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            let mut course = Course::new(rate, shape.clone(), spin::START * 0.5 + Vector::Y * STANDING);
            let bundle =
                (RigidBody::Kinematic, FollowTransform, spin::disc(), Transform::from_xyz(0.0, -0.5, 0.0));
            let lift = course.app.world_mut().spawn(bundle).id();
            course.walk(Vector::ZERO, 0.2);
            let what = (name, rate);
            for i in 1..=rate {
                let t = i as f32 / rate as f32;
                let height = 1.5 * (1.0 - (2.2 * t).cos());
                let turn = if spin::IS_LEVEL {
                    bevy_math::Quat::from_rotation_y(2.0 * t)
                } else {
                    Default::default()
                };
                set(&mut course, lift, Transform::from_xyz(0.0, height - 0.5, 0.0).with_rotation(turn));
                let sample = course.tick();
                let lift = course.get::<Position>(lift).0;
                assert!(
                    (lift.y - (height as Scalar) + 0.5).abs() < 1.0e-4,
                    "{what:?}: it is there in the step"
                );
                let gap = sample.position.y - lift.y - 0.5 - 0.9;
                assert!((gap - SKIN).abs() < 2.0e-4, "{what:?}, tick {i}: a gap of {gap}");
                assert!(sample.state.is_grounded(), "{what:?}: {:?}", sample.state);
                let radius = (sample.position - Vector::Y * sample.position.y).length();
                assert!((radius - 0.5 * spin::START.length()).abs() < 2.0e-4, "{what:?}: {radius}");
            }
        }
    }
}

#[test]
fn trains_carry_and_give_their_speed_to_who_jumps() {
    for (name, shape) in figures() {
        for rate in [30, 64, 360] {
            let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
            let train = moving(&mut course, block(Vector::ONE * 8.0), Vector::NEG_Y * 4.0, Vector::X * 7.0);
            course.walk(Vector::ZERO, 1.0);
            let offset = course.position().x - course.get::<Position>(train).0.x;
            assert!(offset.abs() < 0.2, "{name} at {rate}: {offset}");
            // Walking on it adds to its speed.
            course.walk(Vector::X * 2.0, 1.0);
            let walked = course.position().x - course.get::<Position>(train).0.x - offset;
            assert!((walked - 2.0).abs() < 1.0e-3, "{name} at {rate}: {walked}");
            course.jump(4.0);
            let path = course.walk(Vector::ZERO, 0.5);
            assert!(path.iter().all(|p| p.state.ground == GroundState::InAir), "{name} at {rate}");
            let drift = course.position().x - course.get::<Position>(train).0.x - offset - walked;
            assert!(drift.abs() < 1.0e-3, "{name} at {rate}: it flies with the train: {drift}");
            course.walk(Vector::ZERO, 0.7);
            assert!(course.state().is_grounded());
            // A stop takes the one that stands with it.
            set(&mut course, train, LinearVelocity::ZERO);
            let at = course.position();
            course.walk(Vector::ZERO, 0.5);
            assert!((course.position() - at).length() < 1.0e-4, "{name} at {rate}");
        }
    }
}

/// A wheel about the axis of the view, in space a carousel about `up` as well.
#[test]
fn a_carousel_carries_round_exactly() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            let mut course = Course::new(rate, shape.clone(), spin::START + Vector::Y * STANDING);
            let disc = moving(&mut course, spin::disc(), Vector::NEG_Y * 0.5, Vector::ZERO);
            course.walk(Vector::ZERO, 0.2);
            let start = course.position();
            set(&mut course, disc, AngularVelocity(spin::velocity(TAU)));
            let path = course.walk(Vector::ZERO, 1.0);
            let what = (name, rate);
            if spin::IS_LEVEL {
                let off = (course.position() - start).length();
                assert!(off < 1.0e-4, "{what:?}: {off} after a turn");
                assert!(path.iter().all(|p| p.state.is_grounded()), "{what:?}");
                let radius = path.iter().map(|p| (p.position - Vector::Y * p.position.y).length());
                assert!(radius.clone().all(|r| (r - spin::START.length()).abs() < 1.0e-4), "{what:?}");
                assert_eq!(course.state().ground_spin, spin::velocity(TAU), "{what:?}");
            } else {
                assert!(path.iter().any(|p| !p.state.is_grounded()), "{what:?}: it cannot stand on a wall");
            }
        }
    }
}

/// What the app moves by its position, without a velocity, and what falls away.
#[test]
fn platforms_may_be_teleported_or_despawned() {
    for (name, shape) in figures() {
        for rate in [30, 144] {
            let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
            let shelf =
                fixed(&mut course.app, block(Vector::ONE * 4.0), Vector::NEG_Y * 2.0, Rotation::IDENTITY);
            course.walk(Vector::ZERO, 0.2);
            for i in 1..=rate {
                let at = Vector::X * (2.0 * i as Scalar / rate as Scalar) - Vector::Y * 2.0;
                set(&mut course, shelf, Position(at));
                course.tick();
            }
            assert!((course.position().x - 2.0).abs() < 1.0e-3, "{name} at {rate}: {}", course.position());
            assert!(course.state().is_grounded());
            // The character is put elsewhere: it is not carried back.
            let player = course.player;
            set(&mut course, player, Position(Vector::X * 3.0 + Vector::Y * STANDING));
            course.walk(Vector::ZERO, 0.2);
            assert!((course.position().x - 3.0).abs() < 1.0e-4, "{name} at {rate}: {}", course.position());
            course.app.world_mut().despawn(shelf);
            let path = course.walk(Vector::ZERO, 0.5);
            assert!(path.iter().all(|p| p.state.ground == GroundState::InAir), "{name} at {rate}");
            let fallen = STANDING - course.position().y;
            assert!((fallen - 0.5 * 9.81 * 0.25).abs() < 0.05, "{name} at {rate}: fell {fallen}");
        }
    }
}

#[test]
fn belts_carry_at_the_speed_of_their_surface() {
    for (name, shape) in figures() {
        for rate in [30, 240] {
            let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
            let belt = floor(&mut course.app);
            set(&mut course, belt, SurfaceVelocity(Vector::X * 1.5));
            course.walk(Vector::ZERO, 0.2);
            let start = course.position();
            course.walk(Vector::NEG_X * 0.5, 2.0);
            assert!(
                (course.position().x - start.x - 2.0).abs() < 1.0e-3,
                "{name} at {rate}: {}",
                course.position()
            );
            assert!((course.state().ground_velocity - Vector::X * 1.5).length() < 1.0e-6);
        }
    }
}

/// A door pushes; between a door and a wall there is no room.
#[test]
fn doors_push_and_crush() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
            floor(&mut course.app);
            fixed(
                &mut course.app,
                block(Vector::ONE * 4.0),
                Vector::X * 5.0 + Vector::Y * 2.1,
                Rotation::IDENTITY,
            );
            course.walk(Vector::ZERO, 0.2);
            let at = Vector::X * -3.5 + Vector::Y * 2.1;
            let door = moving(&mut course, block(Vector::ONE * 4.0), at, Vector::X * 3.0);
            let mut crushed = None;
            for i in 0..3 * rate / 2 {
                let sample = course.tick();
                let gap = sample.position.x - course.get::<Position>(door).0.x - 2.0 - 0.4;
                let room = 3.0 - course.get::<Position>(door).0.x - 2.0;
                let what = (name, rate, i);
                if room > 0.8 + 2.2 * SKIN {
                    assert!(gap > SKIN - 3.0e-4, "{what:?}: a gap of {gap}");
                    assert!(!sample.state.is_crushed, "{what:?}: {room} m of room");
                } else if room < 0.78 {
                    crushed = crushed.or(Some(sample.state.is_crushed));
                }
            }
            assert_eq!(crushed, Some(true), "{name} at {rate}");
        }
    }
}

/// By the largest force, so heavier crates are slower; none is thrown.
#[test]
fn crates_are_pushed_by_their_mass() {
    for (name, shape) in figures() {
        for rate in [30, 60, 144] {
            let mut ways = Vec::new();
            for mass in [1.0, 10.0, 100.0, 1000.0] {
                let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
                floor(&mut course.app);
                let at = Vector::X * 1.5 + Vector::Y * 0.5;
                let bundle =
                    (RigidBody::Dynamic, block(Vector::ONE), Position(at), Mass(mass), Friction::new(0.4));
                let load = course.app.world_mut().spawn(bundle).id();
                course.walk(Vector::ZERO, 0.5);
                let mut fastest: Scalar = 0.0;
                for _ in 0..2 * rate {
                    course.walk(Vector::X * 2.0, 1.0 / rate as Scalar);
                    fastest = fastest.max(course.get::<LinearVelocity>(load).0.length());
                }
                let what = (name, rate, mass);
                assert!(fastest < 3.0, "{what:?}: it flies at {fastest} m/s");
                ways.push(course.get::<Position>(load).0.x - 1.5);
            }
            assert!(ways.windows(2).all(|w| w[1] < w[0] + 0.05), "{name} at {rate}: {ways:?}");
            assert!(ways[0] > 2.0 && ways[3].abs() < 1.0e-2, "{name} at {rate}: {ways:?}");
        }
    }
}

#[test]
fn who_stands_on_a_crate_weighs_on_it() {
    for (name, shape) in figures() {
        let mut course = Course::new(60, shape.clone(), Vector::Y * (1.0 + STANDING));
        floor(&mut course.app);
        let bundle = (RigidBody::Dynamic, block(Vector::ONE), Position(Vector::Y * 0.5), Mass(30.0));
        let load = course.app.world_mut().spawn(bundle).id();
        let path = course.walk(Vector::ZERO, 3.0);
        assert!(path[60..].iter().all(|p| p.state.is_grounded()), "{name}");
        assert_eq!(course.state().ground_entity, Some(load));
        let rest = path.last().unwrap().position;
        assert!((rest.y - 1.0 - STANDING).abs() < 5.0e-3, "{name}: {rest}");
        assert!(path[120..].iter().all(|p| (p.position - rest).length() < 1.0e-3), "{name}: it shakes");
    }
}
