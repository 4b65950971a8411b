//! Platforms that are passed from below, and ceilings.

use super::{Course, SKIN, block, figures, fixed, floor, rates};
use avian::{character_controller::controller::GroundState, math::*, prelude::*, schedule::PhysicsSchedule};
use bevy_ecs::prelude::*;

const STANDING: Scalar = 0.9 + SKIN;

/// A platform that can be passed from below.
#[derive(Component)]
struct OneWay;

/// The platform that a character falls through.
#[derive(Component, Default)]
struct Through(Option<Entity>);

/// As in the documentation: a platform is there for those whose feet are above it.
fn pass_platforms(
    platforms: Query<(Entity, &Collider, &Position, &Rotation), With<OneWay>>,
    mut characters: Query<(&mut CharacterController, &mut Through, &Collider, &Position, &Rotation)>,
) {
    for (mut controller, mut through, shape, position, rotation) in &mut characters {
        let feet = shape.aabb(position.0, *rotation).min.y;
        let above = |(entity, shape, at, turn): &(Entity, &Collider, &Position, &Rotation)| {
            (shape.aabb(at.0, **turn).max.y > feet).then_some(*entity)
        };
        let mut passed: Vec<Entity> = platforms.iter().filter_map(|platform| above(&platform)).collect();
        if through.0.is_some_and(|platform| passed.contains(&platform)) {
            through.0 = None;
        }
        passed.extend(through.0);
        controller.filter = SpatialQueryFilter::from_excluded_entities(passed);
    }
}

/// Jumped through from below, stood on, walked on, dropped through; at rest and as a lift.
#[test]
fn platforms_by_a_filter_are_one_way() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            for speed in [0.0, 0.3] {
                let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
                course.app.add_systems(PhysicsSchedule, pass_platforms.before(CharacterSystems));
                floor(&mut course.app);
                let size = Vector::ONE * 6.0 + Vector::Y * -5.8;
                let bundle = (RigidBody::Kinematic, block(size), Position(Vector::Y * 2.4), OneWay);
                let platform = course.app.world_mut().spawn(bundle).id();
                let lower = fixed(&mut course.app, block(size), Vector::Y * 1.2, Rotation::IDENTITY);
                course.app.world_mut().entity_mut(lower).insert(OneWay);
                let player = course.player;
                course.app.world_mut().entity_mut(player).insert(Through::default());
                course.app.world_mut().entity_mut(platform).insert(LinearVelocity(Vector::Y * speed));
                let what = (name, rate, speed);
                course.walk(Vector::ZERO, 0.2);
                for (expected, jump) in [(lower, 5.5), (platform, 7.0)] {
                    course.jump(jump);
                    let path = course.walk(Vector::X * 0.5, 1.6);
                    assert!(course.state().is_grounded(), "{what:?}: {:?}", course.state());
                    assert_eq!(
                        course.state().ground_entity,
                        Some(expected),
                        "{what:?}: {}",
                        course.position()
                    );
                    let hit = path.iter().find(|p| p.state.ground == GroundState::NotSupported);
                    assert!(hit.is_none(), "{what:?}: {hit:?}");
                }
                let gap = course.position().y - course.get::<Position>(platform).0.y - 0.1 - 0.9;
                assert!((gap - SKIN).abs() < 2.0e-4, "{what:?}: a gap of {gap}");
                // One tick is enough, and the one below catches it.
                for left in [lower, player] {
                    let through = course.state().ground_entity;
                    course.app.world_mut().entity_mut(player).insert(Through(through));
                    course.walk(Vector::ZERO, 1.0);
                    assert!(course.state().is_grounded(), "{what:?}: {:?}", course.state());
                    let is_floor = left == player;
                    assert_eq!(course.state().ground_entity == Some(left), !is_floor, "{what:?}");
                }
                assert!((course.position().y - STANDING).abs() < 2.0e-4, "{what:?}: {}", course.position());
            }
        }
    }
}

/// The jump ends at the ceiling, and the fall begins there.
#[test]
fn a_ceiling_ends_a_jump() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
            floor(&mut course.app);
            let room = 0.3;
            let top = 1.8 + 2.0 * SKIN + room;
            fixed(&mut course.app, block(Vector::ONE * 20.0), Vector::Y * (top + 10.0), Rotation::IDENTITY);
            course.walk(Vector::ZERO, 0.2);
            course.jump(4.0);
            let path = course.walk(Vector::X * 2.0, 1.0);
            let what = (name, rate);
            let highest = path.iter().fold(0.0, |top: Scalar, p| top.max(p.position.y)) - STANDING;
            assert!((highest - room).abs() < 2.0e-4, "{what:?}: {highest}");
            let air = path.iter().filter(|p| !p.state.is_grounded()).count() as Scalar / rate as Scalar;
            let up = (4.0 - (16.0 - 2.0 * 9.81 * room as Scalar).sqrt()) / 9.81;
            let down = (2.0 * room / 9.81).sqrt();
            let tick = 1.0 / rate as Scalar;
            assert!((air - up - down).abs() < 1.5 * tick, "{what:?}: {air} s, not {}", up + down);
            assert!((course.position().x - 2.0).abs() < 1.0e-3, "{what:?}: {}", course.position());
        }
    }
}
