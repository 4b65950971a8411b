//! Platforms that are passed from below, and ceilings.

use super::{Course, SKIN, all_at, block, each, figures, fixed, floor, lane, usual};
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
    let cases = each(&[0.0, 0.3]);
    for rate in usual() {
        let starts = cases.iter().map(|(.., shape)| (shape.clone(), Vector::Y * STANDING));
        let mut course = Course::side_by_side(rate, starts);
        course.app.add_systems(PhysicsSchedule, pass_platforms.before(CharacterSystems));
        let ground = floor(&mut course.app);
        let size = Vector::ONE * 6.0 + Vector::Y * -5.8;
        let mut platforms = Vec::new();
        for (i, (_, speed, _)) in cases.iter().enumerate() {
            let motion = (RigidBody::Kinematic, LinearVelocity(Vector::Y * *speed));
            let upper = (motion, block(size), Position(Vector::Y * 2.4), OneWay, lane(i));
            let upper = course.app.world_mut().spawn(upper).id();
            let lower = course.fix_in_lane(i, block(size), Vector::Y * 1.2, Rotation::IDENTITY);
            course.app.world_mut().entity_mut(lower).insert(OneWay);
            course.app.world_mut().entity_mut(course.players[i]).insert(Through::default());
            platforms.push([lower, upper]);
        }
        course.walk(Vector::ZERO, 0.1);
        for (which, jump) in [(0, 5.5), (1, 7.0)] {
            course.jump(jump);
            let paths = course.walk_all(|_| Vector::X * 0.5, 1.4);
            for (i, (name, speed, _)) in cases.iter().enumerate() {
                let what = (name, rate, speed);
                let end = paths[i].last().expect("it lands");
                assert!(end.state.is_grounded(), "{what:?}: {end:?}");
                assert_eq!(end.state.ground_entity, Some(platforms[i][which]), "{what:?}: {end:?}");
                let hit = paths[i].iter().find(|p| p.state.ground == GroundState::NotSupported);
                assert!(hit.is_none(), "{what:?}: {hit:?}");
                let gap = end.position.y - course.get::<Position>(platforms[i][which]).0.y - 0.1 - 0.9;
                assert!((gap - SKIN).abs() < 2.0e-4, "{what:?}: a gap of {gap}");
            }
        }
        // One tick is enough, and the one below catches it.
        for which in [0, 1] {
            for &player in &course.players {
                let through = course.get::<CharacterState>(player).ground_entity;
                course.app.world_mut().entity_mut(player).insert(Through(through));
            }
            let paths = course.walk_all(|_| Vector::ZERO, 0.9);
            for (i, (name, speed, _)) in cases.iter().enumerate() {
                let what = (name, rate, speed);
                let end = paths[i].last().expect("it lands");
                assert!(end.state.is_grounded(), "{what:?}: {end:?}");
                let expected = if which == 0 { platforms[i][0] } else { ground };
                assert_eq!(end.state.ground_entity, Some(expected), "{what:?}: {end:?}");
                let is_low = (end.position.y - STANDING).abs() < 2.0e-4;
                assert!(is_low || which == 0, "{what:?}: {end:?}");
            }
        }
    }
}

/// The jump ends at the ceiling, and the fall begins there.
#[test]
fn a_ceiling_ends_a_jump() {
    for rate in usual() {
        let mut course = all_at(rate, Vector::Y * STANDING);
        floor(&mut course.app);
        let room = 0.3;
        let top = 1.8 + 2.0 * SKIN + room;
        fixed(&mut course.app, block(Vector::ONE * 20.0), Vector::Y * (top + 10.0), Rotation::IDENTITY);
        course.walk(Vector::ZERO, 0.1);
        course.jump(4.0);
        let paths = course.walk_all(|_| Vector::X * 2.0, 0.6);
        for ((name, _), path) in figures().iter().zip(paths) {
            let what = (name, rate);
            let highest = path.iter().fold(0.0, |top: Scalar, p| top.max(p.position.y)) - STANDING;
            assert!((highest - room).abs() < 2.0e-4, "{what:?}: {highest}");
            let air = path.iter().filter(|p| !p.state.is_grounded()).count() as Scalar / rate as Scalar;
            let up = (4.0 - (16.0 - 2.0 * 9.81 * room as Scalar).sqrt()) / 9.81;
            let down = (2.0 * room / 9.81).sqrt();
            let tick = 1.0 / rate as Scalar;
            assert!((air - up - down).abs() < 1.5 * tick, "{what:?}: {air} s, not {}", up + down);
            let (end, way) = (path.last().expect("it lands"), 2.0 * path.len() as Scalar * tick);
            assert!((end.position.x - way).abs() < 1.0e-3, "{what:?}: {end:?}");
        }
    }
}
