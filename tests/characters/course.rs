//! More of the course: piles, starts inside of things, many characters.

use super::{Course, SKIN, block, figures, fixed, floor, rates, terrain};
use avian::{math::*, prelude::*};
use bevy_ecs::prelude::*;

const STANDING: Scalar = 0.9 + SKIN;

/// On crates that lie on each other, and on a chain of limbs.
#[test]
fn who_stands_on_a_pile_or_on_limbs_is_not_thrown() {
    for (name, shape) in figures() {
        for rate in [30, 144] {
            let mut course = Course::new(rate, shape.clone(), Vector::Y * 4.0);
            floor(&mut course.app);
            for (x, y) in [(-0.5, 0.0), (0.5, 0.0), (0.0, 1.0)] {
                let at = Vector::X * (x * 1.05) + Vector::Y * (y + 0.5);
                let crates = (RigidBody::Dynamic, block(Vector::ONE), Position(at), Mass(40.0));
                course.app.world_mut().spawn(crates);
            }
            let what = (name, rate);
            let path = course.walk(Vector::ZERO, 3.0);
            let last = *path.last().expect("it stands");
            assert!(last.state.is_grounded(), "{what:?}: {last:?}");
            assert!((last.position.y - 2.0 - STANDING).abs() < 0.02, "{what:?}: {last:?}");
            let shakes =
                path[2 * rate as usize..].iter().find(|p| (p.position - last.position).length() > 2.0e-3);
            assert!(shakes.is_none(), "{what:?}: {shakes:?}");
            // Limbs of 8 kg, jointed, that lie on the floor.
            let start = Vector::X * 6.0;
            let mut before: Option<Entity> = None;
            for i in 0..5 {
                let at = start + Vector::X * (0.6 * i as Scalar) + Vector::Y * 0.2;
                let size = Vector::ONE * 0.3 + Vector::X * 0.25;
                let limb = (RigidBody::Dynamic, block(size), Position(at), Mass(8.0));
                let limb = course.app.world_mut().spawn(limb).id();
                if let Some(before) = before {
                    let joint = RevoluteJoint::new(before, limb)
                        .with_local_anchor1(Vector::X * 0.3)
                        .with_local_anchor2(Vector::X * -0.3);
                    course.app.world_mut().spawn(joint);
                }
                before = Some(limb);
            }
            let player = course.player;
            let above = Position(start + Vector::X * 1.2 + Vector::Y * 2.0);
            course.app.world_mut().entity_mut(player).insert(above);
            course.walk(Vector::ZERO, 1.5);
            let path = course.walk(Vector::X * 1.0, 2.0);
            for p in &path {
                assert!(p.position.y > 0.85 && p.position.y < 2.0, "{what:?}: {p:?}");
            }
            let still = course.walk(Vector::ZERO, 1.5).pop().expect("it stands");
            assert!(still.state.is_grounded(), "{what:?}: {still:?}");
        }
    }
}

/// From where it overlaps a block by a share of its own height.
#[test]
fn who_starts_inside_gets_out_or_stays() {
    for (name, shape) in figures() {
        for &rate in rates(name) {
            for depth in [0.0, 0.1, 0.25, 0.45] {
                let mut course = Course::new(rate, shape.clone(), Vector::Y * (0.9 - depth));
                floor(&mut course.app);
                let what = (name, rate, depth);
                let path = course.walk(Vector::ZERO, 0.3);
                let end = path.last().expect("it stands");
                assert!((end.position.y - STANDING).abs() < 3.0e-4, "{what:?}: {end:?}");
                assert!(end.state.is_grounded(), "{what:?}: {end:?}");
                course.walk(Vector::X * 2.0, 0.5);
                assert!((course.position().x - 1.0).abs() < 1.0e-3, "{what:?}: {}", course.position());
            }
            // By a teleport into a wall, from the side.
            let mut course = Course::new(rate, shape.clone(), Vector::Y * STANDING);
            floor(&mut course.app);
            let at = Vector::X * 4.0 + Vector::Y * 2.0;
            fixed(&mut course.app, block(Vector::ONE * 4.0), at, Rotation::IDENTITY);
            course.walk(Vector::ZERO, 0.2);
            let player = course.player;
            let at = Vector::X * 1.9 + Vector::Y * STANDING;
            course.app.world_mut().entity_mut(player).insert(Position(at));
            course.walk(Vector::ZERO, 0.3);
            let end = course.position();
            let expected = Vector::X * (1.6 - SKIN) + Vector::Y * STANDING;
            assert!((end - expected).length() < 5.0e-4, "{name} at {rate}: {end}");
            // In the middle of a block it stays finite, and walks out.
            let at = Vector::X * 4.0 + Vector::Y * 2.0;
            course.app.world_mut().entity_mut(player).insert(Position(at));
            let path = course.walk(Vector::X * 4.0, 2.0);
            let fastest = path.windows(2).map(|p| (p[1].position - p[0].position).length());
            let fastest = fastest.fold(0.0, Scalar::max);
            // Overlaps of up to half a metre are left at once.
            assert!(fastest < 0.5 + 10.0 / rate as Scalar, "{name} at {rate}: thrown by {fastest} m");
            assert!(course.position().is_finite(), "{name} at {rate}");
        }
    }
}

/// The height of a hilly level.
fn hill(x: Scalar) -> Scalar {
    0.6 * (x * 0.7).sin() + 0.3 * (x * 1.9 + 1.0).sin()
}

/// Thirty characters on hills; twice, with the same bits.
#[test]
fn a_crowd_on_a_mesh_stays_on_it_and_does_the_same_again() {
    let run = |name: &str, shape: &Collider| {
        let at = |x: Scalar| Vector::X * x + Vector::Y * (hill(x) + 1.3);
        let mut course = Course::new(60, shape.clone(), at(0.0));
        let points: Vec<Vector> = (-300..=300).map(|i| at(0.1 * i as Scalar) - Vector::Y * 1.3).collect();
        fixed(&mut course.app, terrain(&points), Vector::ZERO, Rotation::IDENTITY);
        let mut crowd = Vec::new();
        for i in -15..15 {
            let velocity = Vector::X * (if i % 2 == 0 { 1.5 } else { -1.0 });
            let input = CharacterInput { velocity, ..Default::default() };
            let bundle =
                (CharacterController::default(), input, shape.clone(), Position(at(1.2 * i as Scalar + 0.6)));
            crowd.push(course.app.world_mut().spawn(bundle).id());
        }
        for _ in 0..120 {
            course.tick();
        }
        let end = |one: &Entity| {
            let (p, state) = (course.get::<Position>(*one).0, course.get::<CharacterState>(*one));
            let above = p.y - hill(p.x);
            assert!(above > 0.85 && above < 1.4, "{name}: {above} m above the ground at {p}");
            assert!(state.is_grounded(), "{name}: {state:?}");
            (p, state)
        };
        crowd.iter().map(end).collect::<Vec<_>>()
    };
    for (name, shape) in figures() {
        assert_eq!(run(name, &shape), run(name, &shape), "{name}");
    }
}
