//! Characters among each other.

use super::{Course, SKIN, block, figures, fixed, floor};
use avian::{math::*, prelude::*};
use bevy_ecs::prelude::*;

const STANDING: Scalar = 0.9 + SKIN;

fn friendly() -> CharacterController {
    CharacterController { friends: LayerMask::ALL, ..Default::default() }
}

fn spawn(course: &mut Course, shape: &Collider, at: Vector, velocity: Vector) -> Entity {
    let input = CharacterInput { velocity, ..Default::default() };
    course.app.world_mut().spawn((friendly(), input, shape.clone(), Position(at))).id()
}

/// A course on a floor, with a player that has friends.
fn course(shape: &Collider, at: Vector) -> Course {
    let mut course = Course::new(60, shape.clone(), at);
    floor(&mut course.app);
    let player = course.player;
    course.app.world_mut().entity_mut(player).insert(friendly());
    course
}

#[test]
fn friends_walk_through_each_other_and_part_when_they_stand() {
    for (name, shape) in figures() {
        let mut course = course(&shape, Vector::X * -2.0 + Vector::Y * STANDING);
        let other = spawn(&mut course, &shape, Vector::Y * STANDING, Vector::ZERO);
        let path = course.walk(Vector::X * 3.0, 2.0);
        assert!(path.iter().all(|p| p.state.is_grounded()), "{name}");
        assert!(path.windows(2).all(|p| p[1].position.x > p[0].position.x), "{name}: it is stopped");
        let moved = course.get::<Position>(other).0.x.abs();
        assert!(moved > 0.05 && moved < 1.0, "{name}: the other yields, by {moved}");
        // Half of the way each.
        let at = course.get::<Position>(other).0 + Vector::X * 0.5;
        let player = course.player;
        course.app.world_mut().entity_mut(player).insert(Position(at));
        course.walk(Vector::ZERO, 1.0);
        let (a, b) = (course.position(), course.get::<Position>(other).0);
        assert!((a.x - b.x - 0.8).abs() < 2.0e-3, "{name}: {} m between them", a.x - b.x);
        assert!((a.x - at.x - 0.15).abs() < 2.0e-3, "{name}: {a} from {at}");
    }
}

#[test]
fn friends_in_the_same_place_part_at_the_speed_set() {
    for (name, shape) in figures() {
        let mut course = course(&shape, Vector::Y * STANDING);
        let other = spawn(&mut course, &shape, Vector::Y * STANDING, Vector::ZERO);
        let mut before = 0.0;
        for _ in 0..60 {
            course.tick();
            let between = (course.position() - course.get::<Position>(other).0).length();
            assert!(between - before < 4.0 / 60.0 + 1.0e-4, "{name}: {before} to {between}");
            before = between;
        }
        assert!(before > 0.79, "{name}: {before} m between them");
        assert!(course.state().is_grounded());
    }
}

/// Walls are no friends, nor are those in other layers.
#[test]
fn only_characters_in_the_layers_are_friends() {
    for (name, shape) in figures() {
        let mut course = course(&shape, Vector::X * -2.0 + Vector::Y * STANDING);
        let at = Vector::X * 4.0 + Vector::Y * 2.0;
        fixed(&mut course.app, block(Vector::ONE * 4.0), at, Rotation::IDENTITY);
        let controller = CharacterController { friends: LayerMask(0b10), ..Default::default() };
        let player = course.player;
        course.app.world_mut().entity_mut(player).insert(controller);
        let friend = spawn(&mut course, &shape, Vector::Y * STANDING, Vector::ZERO);
        let layers = CollisionLayers::new(LayerMask(0b10), LayerMask::ALL);
        course.app.world_mut().entity_mut(friend).insert(layers);
        course.walk(Vector::X * 3.0, 3.0);
        let end = course.position();
        assert!((end.x - 1.6 + SKIN).abs() < 2.0e-3, "{name}: it passes the friend up to the wall, {end}");
        course.app.world_mut().entity_mut(friend).insert(CollisionLayers::DEFAULT);
        let at = course.get::<Position>(friend).0;
        for p in course.walk(Vector::X * -3.0, 2.0) {
            // In space it may walk around.
            let between = (p.position - course.get::<Position>(friend).0).length();
            assert!(between > 0.79, "{name}: it passes through a stranger: {p:?}, {at}");
        }
    }
}

/// A ray, a shape and a sensor meet the collider of a character: it needs no second body.
#[test]
fn rays_and_sensors_see_a_character() {
    for (name, shape) in figures() {
        let mut course = Course::new(60, shape.clone(), Vector::Y * STANDING);
        floor(&mut course.app);
        let bundle = (
            RigidBody::Static,
            block(Vector::ONE),
            Position(Vector::X * 3.0 + Vector::Y),
            (Sensor, CollidingEntities::default()),
        );
        let zone = course.app.world_mut().spawn(bundle).id();
        course.walk(Vector::X * 2.0, 0.5);
        let (player, at) = (course.player, course.position());
        let hit = super::ask(&mut course.app, move |mover| {
            let from = at - Vector::X * 5.0;
            mover.spatial_query.cast_ray(from, Dir::X, 10.0, true, &SpatialQueryFilter::DEFAULT)
        });
        let hit = hit.unwrap_or_else(|| panic!("{name}: the ray passes"));
        assert_eq!(hit.entity, player, "{name}");
        assert!((hit.distance - 4.6).abs() < 1.0e-4, "{name}: {}", hit.distance);
        let inside = |course: &Course| {
            course.app.world().get::<CollidingEntities>(zone).expect("a zone").contains(&player)
        };
        assert!(!inside(&course), "{name}: it is not there yet");
        course.walk(Vector::X * 2.0, 0.8);
        assert!(inside(&course), "{name}: the sensor does not see it");
        assert!(course.position().x > 2.0, "{name}: the sensor stops it");
    }
}
