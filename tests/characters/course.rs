//! More of the course: piles, ragdolls, and starts inside of things.

use super::{Course, SKIN, block, each, figures, fixed, floor, lane, some, usual};
use avian::{math::*, prelude::*};
use bevy_math::Quat;
use bevy_transform::components::Transform;

const STANDING: Scalar = 0.9 + SKIN;

/// On crates that lie on each other, and on a human that lies on the floor.
#[test]
fn who_stands_on_a_pile_or_on_a_ragdoll_is_not_thrown() {
    let figures = figures();
    for &rate in some(&[30, 60, 144]) {
        let starts = figures.iter().map(|(_, shape)| (shape.clone(), Vector::Y * 4.0));
        let mut course = Course::side_by_side(rate, starts);
        floor(&mut course.app);
        let mut humans = Vec::new();
        for i in 0..figures.len() {
            for (x, y) in [(-0.5, 0.0), (0.5, 0.0), (0.0, 1.0)] {
                let at = Vector::X * (x * 1.05) + Vector::Y * (y + 0.5);
                let crates = (RigidBody::Dynamic, block(Vector::ONE), Position(at), Mass(40.0), lane(i));
                course.app.world_mut().spawn(crates);
            }
            let lies = Transform::from_xyz(8.0, 0.6, 0.0).with_rotation(Quat::from_rotation_z(1.5));
            let human = HumanRagdoll::default().spawn(&mut course.app.world_mut().commands(), lies);
            course.app.world_mut().flush();
            for bone in Bone::ALL {
                course.app.world_mut().entity_mut(human.bone(bone)).insert(lane(i));
            }
            humans.push(human);
        }
        let paths = course.walk_all(|_| Vector::ZERO, 3.0);
        for ((name, _), path) in figures.iter().zip(&paths) {
            let last = path.last().expect("it stands");
            assert!(last.state.is_grounded(), "{name} at {rate}: {last:?}");
            assert!((last.position.y - 2.0 - STANDING).abs() < 0.02, "{name} at {rate}: {last:?}");
            let late = &path[2 * rate as usize..];
            let shakes = late.iter().find(|p| (p.position - last.position).length() > 2.0e-3);
            assert!(shakes.is_none(), "{name} at {rate}: {shakes:?}");
        }
        for (i, human) in humans.iter().enumerate() {
            let chest = course.get::<Position>(human.bone(Bone::Chest)).0;
            course.put(i, chest + Vector::Y * 1.6);
        }
        // It stands, walks off over the limbs, and stands.
        for (velocity, seconds) in [(0.0, 1.5), (1.0, 1.5), (0.0, 0.5)] {
            let paths = course.walk_all(|_| Vector::X * velocity, seconds);
            for (i, path) in paths.iter().enumerate() {
                let what = (figures[i].0, rate, velocity);
                let wrong = path.iter().find(|p| !(p.position.y > 0.85 && p.position.y < 2.5));
                assert!(wrong.is_none(), "{what:?}: {wrong:?}");
                let last = path.last().expect("it stands");
                assert!(velocity != 0.0 || last.state.is_grounded(), "{what:?}: {last:?}");
                for bone in Bone::ALL {
                    let speed = course.get::<LinearVelocity>(humans[i].bone(bone)).0.length();
                    assert!(speed < 5.0, "{what:?}: {bone:?} flies at {speed} m/s");
                }
            }
        }
    }
}

/// From where it overlaps the floor by a share of its own height, and a wall from the side.
#[test]
fn who_starts_inside_gets_out_or_stays() {
    let cases = each(&[0.0, 0.1, 0.25, 0.45]);
    for rate in usual() {
        let starts = cases.iter().map(|(_, depth, shape)| (shape.clone(), Vector::Y * (0.9 - depth)));
        let mut course = Course::side_by_side(rate, starts);
        floor(&mut course.app);
        let settled = course.walk_all(|_| Vector::ZERO, 0.2);
        let walked = course.walk_all(|_| Vector::X * 2.0, 0.5);
        // By a teleport into a wall.
        let at = Vector::X * 4.0 + Vector::Y * 2.0;
        fixed(&mut course.app, block(Vector::ONE * 4.0), at, Rotation::IDENTITY);
        (0..cases.len()).for_each(|i| course.put(i, Vector::X * 1.9 + Vector::Y * STANDING));
        let beside = course.walk_all(|_| Vector::ZERO, 0.2);
        // In the middle of a block it stays finite, and walks out.
        (0..cases.len()).for_each(|i| course.put(i, at));
        let out = course.walk_all(|_| Vector::X * 4.0, 1.2);
        for (i, (name, depth, _)) in cases.iter().enumerate() {
            let what = (name, rate, depth);
            let [stood, moved, side, free] =
                [&settled, &walked, &beside, &out].map(|paths| *paths[i].last().expect("it stands"));
            assert!((stood.position.y - STANDING).abs() < 3.0e-4, "{what:?}: {stood:?}");
            assert!(stood.state.is_grounded(), "{what:?}: {stood:?}");
            assert!((moved.position.x - 1.0).abs() < 1.0e-3, "{what:?}: {moved:?}");
            let expected = Vector::X * (1.6 - SKIN) + Vector::Y * STANDING;
            assert!((side.position - expected).length() < 5.0e-4, "{what:?}: {side:?}");
            let fastest = out[i].windows(2).map(|p| (p[1].position - p[0].position).length());
            let fastest = fastest.fold(0.0, Scalar::max);
            // Overlaps of up to half a metre are left at once.
            assert!(fastest < 0.5 + 10.0 / rate as Scalar, "{what:?}: thrown by {fastest} m");
            assert!(free.position.is_finite(), "{what:?}: {free:?}");
        }
    }
}
