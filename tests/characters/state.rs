//! The state of characters: events, copies, other directions of `up`, and input that is none.

use super::{Course, SKIN, block, figures, fixed, floor};
use avian::{math::*, prelude::*};
use bevy_ecs::prelude::*;
use bevy_time::Time;

const STANDING: Scalar = 0.9 + SKIN;

/// What observers heard.
#[derive(Resource, Default, Debug)]
struct Heard {
    landed: Vec<Scalar>,
    left: usize,
    hits: Vec<Entity>,
}

#[test]
fn landing_leaving_and_hitting_are_told_once() {
    for (name, shape) in figures() {
        let mut course = Course::new(60, shape, Vector::Y * (1.0 + STANDING));
        floor(&mut course.app);
        let wall = fixed(
            &mut course.app,
            block(Vector::ONE * 4.0),
            Vector::X * 5.0 + Vector::Y * 2.0,
            Rotation::IDENTITY,
        );
        let world = course.app.world_mut();
        world.init_resource::<Heard>();
        world.add_observer(|on: On<CharacterLanded>, mut heard: ResMut<Heard>| heard.landed.push(on.speed));
        world.add_observer(|_: On<CharacterLeftGround>, mut heard: ResMut<Heard>| heard.left += 1);
        world.add_observer(|on: On<CharacterHit>, mut heard: ResMut<Heard>| heard.hits.push(on.collider));
        course.walk(Vector::ZERO, 1.0);
        let heard = course.app.world().resource::<Heard>();
        assert_eq!((heard.landed.len(), heard.left), (1, 0), "{name}: {heard:?}");
        // From 1 m.
        assert!((heard.landed[0] - (2.0 * 9.81 as Scalar).sqrt()).abs() < 0.2, "{name}: {heard:?}");
        course.jump(3.0);
        course.walk(Vector::ZERO, 1.0);
        let heard = course.app.world().resource::<Heard>();
        assert_eq!((heard.landed.len(), heard.left), (2, 1), "{name}: {heard:?}");
        assert!(heard.hits.is_empty(), "{name}: {heard:?}");
        course.walk(Vector::X * 4.0, 1.5);
        let heard = course.app.world().resource::<Heard>();
        assert!(!heard.hits.is_empty() && heard.hits.iter().all(|hit| *hit == wall), "{name}: {heard:?}");
    }
}

/// Copied in mid-air, over a slope.
#[test]
fn a_copy_of_the_components_goes_on_with_the_same_bits() {
    for (name, shape) in figures() {
        let mut course = Course::new(64, shape, Vector::Y * STANDING);
        floor(&mut course.app);
        fixed(
            &mut course.app,
            block(Vector::ONE * 4.0),
            Vector::X * 5.0 + Vector::Y * -1.8,
            Rotation::IDENTITY,
        );
        course.walk(Vector::ZERO, 0.3);
        course.jump(4.0);
        course.walk(Vector::X * 3.0, 0.3);
        let player = course.player;
        let copy = (
            course.get::<Position>(player),
            course.get::<LinearVelocity>(player),
            course.get::<CharacterState>(player),
            course.get::<CharacterInput>(player),
        );
        let first = course.walk(Vector::X * 3.0, 1.0);
        course.app.world_mut().entity_mut(player).insert(copy);
        let again = course.walk(Vector::X * 3.0, 1.0);
        for (a, b) in first.iter().zip(&again) {
            assert_eq!((a.position, a.state), (b.position, b.state), "{name}");
        }
    }
}

/// On the side of a block, as on a planet.
#[test]
fn up_may_be_any_direction() {
    for (name, shape) in figures() {
        let mut course = Course::new(60, shape.clone(), Vector::X * 3.0);
        fixed(&mut course.app, block(Vector::ONE * 40.0), Vector::NEG_X * 20.0, Rotation::IDENTITY);
        let controller = CharacterController { up: Dir::X, ..Default::default() };
        let player = course.player;
        course.app.world_mut().entity_mut(player).insert(controller);
        course.walk(Vector::ZERO, 2.0);
        assert!(course.state().is_grounded(), "{name}: {:?}", course.state());
        assert_eq!(course.state().ground_normal.round(), Vector::X, "{name}");
        course.walk(Vector::Y * 2.0, 1.0);
        let end = course.position();
        assert!((end.y - 2.0).abs() < 1.0e-3 && (end.x - 0.4 - SKIN).abs() < 2.0e-4, "{name}: {end}");
    }
}

#[test]
fn two_that_meet_stay_apart() {
    for (name, shape) in figures() {
        let mut course = Course::new(60, shape.clone(), Vector::X * -2.0 + Vector::Y * STANDING);
        floor(&mut course.app);
        let place = Position(Vector::X * 2.0 + Vector::Y * STANDING);
        let input = CharacterInput { velocity: Vector::NEG_X * 3.0, ..Default::default() };
        let other = course.app.world_mut().spawn((CharacterController::default(), input, shape, place)).id();
        let path = course.walk(Vector::X * 3.0, 2.0);
        let end = course.position();
        let between = course.get::<Position>(other).0.x - end.x;
        assert!((between - 0.8).abs() < 0.03, "{name}: {between} m between them");
        let late = &path[path.len() / 2..];
        assert!(late.iter().all(|p| (p.position - end).length() < 0.02), "{name}: they shake");
        assert!(path.iter().all(|p| p.state.is_grounded() || p.tick < 3), "{name}");
    }
}

/// It stops, and from then on moves as its app wants: by forces, by a velocity, or as a mover.
#[test]
fn what_is_no_longer_a_character_is_a_body_as_others() {
    for (name, shape) in figures() {
        let mut course = Course::new(60, shape, Vector::Y * 20.0);
        course.walk(Vector::X * 3.0, 0.3);
        let player = course.player;
        course.app.world_mut().entity_mut(player).remove::<CharacterController>();
        let from = course.position();
        course.walk(Vector::X * 3.0, 0.3);
        assert_eq!(course.position(), from, "{name}: it moves on");
        course.app.world_mut().entity_mut(player).insert(LinearVelocity(Vector::X));
        course.walk(Vector::X * 3.0, 0.5);
        let way = course.position() - from;
        assert!((way - Vector::X * 0.5).length() < 1.0e-5, "{name}: {way}");
        let body = (RigidBody::Dynamic, LinearVelocity::ZERO, LockedAxes::ROTATION_LOCKED);
        course.app.world_mut().entity_mut(player).insert(body);
        let from = course.position();
        course.walk(Vector::X * 3.0, 0.5);
        let fallen = from - course.position();
        assert!((fallen - Vector::Y * (0.5 * 9.81 * 0.25)).length() < 0.05, "{name}: {fallen}");
        let body = (DynamicMover::default(), LinearVelocity::ZERO);
        course.app.world_mut().entity_mut(player).insert(body);
        course.walk(Vector::X * 3.0, 0.5);
        let speed = course.get::<LinearVelocity>(player).0.x;
        assert!((speed - 3.0).abs() < 0.01, "{name}: a mover at {speed} m/s");
        course.app.world_mut().entity_mut(player).remove::<DynamicMover>().insert(Friction::new(0.5));
        floor(&mut course.app);
        course.walk(Vector::X * 3.0, 6.0);
        assert!(course.app.world().get::<Sleeping>(player).is_some(), "{name}: it does not fall asleep");
    }
}

#[test]
fn input_that_is_none_moves_nothing() {
    let mut course = Course::new(60, figures().remove(0).1, Vector::Y * STANDING);
    floor(&mut course.app);
    course.walk(Vector::ZERO, 0.2);
    let at = course.position();
    for bad in [Vector::splat(Scalar::NAN), Vector::X * Scalar::INFINITY] {
        course.walk(bad, 0.2);
        assert_eq!(course.position(), at);
    }
    for value in [Scalar::NAN, -1.0, 0.0] {
        let controller = CharacterController {
            max_slope: value,
            step_height: value,
            step_depth: value,
            snap_distance: value,
            skin_width: value,
            mass: value,
            max_push_force: value,
            ..Default::default()
        };
        let player = course.player;
        course.app.world_mut().entity_mut(player).insert(controller);
        course.jump(value);
        course.walk(Vector::X, 0.3);
        assert!(course.position().is_finite() && course.position().y > 0.8, "{value}: {}", course.position());
    }
    // Paused, disabled, without a shape, and gone.
    let player = course.player;
    course.app.world_mut().entity_mut(player).insert(CharacterController::default());
    course.app.world_mut().resource_mut::<Time<Physics>>().pause();
    let at = course.position();
    course.walk(Vector::X, 0.2);
    assert_eq!(course.position(), at);
    course.app.world_mut().resource_mut::<Time<Physics>>().unpause();
    course.app.world_mut().entity_mut(player).insert(RigidBodyDisabled);
    course.walk(Vector::X, 0.2);
    assert_eq!(course.position(), at);
    course.app.world_mut().entity_mut(player).remove::<(RigidBodyDisabled, Collider)>();
    course.walk(Vector::X, 0.2);
    course.app.world_mut().despawn(player);
    for _ in 0..3 {
        super::step(&mut course.app, core::time::Duration::from_millis(16));
    }
}
