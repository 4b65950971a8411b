//! Characters on what moves, and before what moves.

use super::{Course, SKIN, Sample, all_at, block, each, figures, fixed, floor, lane, some, spin, usual};
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
    let cases = each(&[0.5, 5.0]);
    for rate in usual() {
        let starts = cases.iter().map(|(.., shape)| (shape.clone(), Vector::Y * STANDING));
        let mut course = Course::side_by_side(rate, starts);
        let mut lifts = Vec::new();
        for i in 0..cases.len() {
            let lift = moving(&mut course, block(Vector::ONE * 4.0), Vector::NEG_Y * 2.0, Vector::ZERO);
            set(&mut course, lift, lane(i));
            lifts.push(lift);
        }
        course.walk(Vector::ZERO, 0.1);
        for turn in 0..6 {
            let sign = if turn % 2 == 0 { 1.0 } else { -1.0 };
            for (lift, (_, speed, _)) in lifts.iter().zip(&cases) {
                set(&mut course, *lift, LinearVelocity(Vector::Y * (sign * speed)));
            }
            for _ in 0..rate / 3 {
                let samples = course.tick_all();
                for ((sample, lift), (name, speed, _)) in samples.iter().zip(&lifts).zip(&cases) {
                    let gap = sample.position.y - course.get::<Position>(*lift).0.y - 2.0 - 0.9;
                    let what = (name, rate, speed, turn);
                    assert!((gap - SKIN).abs() < 2.0e-4, "{what:?}: a gap of {gap}");
                    assert!(sample.state.is_grounded(), "{what:?}: {:?}", sample.state);
                    assert!((sample.state.ground_velocity.y - sign * speed).abs() < 1.0e-5, "{what:?}");
                }
            }
        }
    }
}

/// By its transform, with turns at up to 7 m/s²; and a carousel.
#[test]
fn feet_stay_on_a_lift_that_follows_its_transform() {
    for rate in usual() {
        let mut course = all_at(rate, spin::START * 0.5 + Vector::Y * STANDING);
        let bundle =
            (RigidBody::Kinematic, FollowTransform, spin::disc(), Transform::from_xyz(0.0, -0.5, 0.0));
        let lift = course.app.world_mut().spawn(bundle).id();
        course.walk(Vector::ZERO, 0.1);
        let figures = figures();
        for i in 1..=rate {
            let t = i as f32 / rate as f32;
            let height = 1.5 * (1.0 - (2.2 * t).cos());
            let turn =
                if spin::IS_LEVEL { bevy_math::Quat::from_rotation_y(2.0 * t) } else { Default::default() };
            set(&mut course, lift, Transform::from_xyz(0.0, height - 0.5, 0.0).with_rotation(turn));
            let samples = course.tick_all();
            let lift = course.get::<Position>(lift).0;
            let off = (lift.y - (height as Scalar) + 0.5).abs();
            assert!(off < 1.0e-4, "{rate}, tick {i}: it is there in the step");
            for (sample, (name, _)) in samples.into_iter().zip(&figures) {
                let what = (name, rate, i);
                let gap = sample.position.y - lift.y - 0.5 - 0.9;
                assert!((gap - SKIN).abs() < 2.0e-4, "{what:?}: a gap of {gap}");
                assert!(sample.state.is_grounded(), "{what:?}: {:?}", sample.state);
                let radius = (sample.position - Vector::Y * sample.position.y).length();
                assert!((radius - 0.5 * spin::START.length()).abs() < 2.0e-4, "{what:?}: {radius}");
            }
        }
    }
}

#[test]
fn trains_carry_and_give_their_speed_to_who_jumps() {
    for &rate in some(&[30, 64, 360]) {
        let mut course = all_at(rate, Vector::Y * STANDING);
        let train = moving(&mut course, block(Vector::ONE * 8.0), Vector::NEG_Y * 4.0, Vector::X * 7.0);
        let offset = |course: &Course, path: &[Sample]| {
            path.last().expect("it rides").position.x - course.get::<Position>(train).0.x
        };
        let figures = figures();
        let all = |course: &Course, paths: &[Vec<Sample>]| -> Vec<Scalar> {
            paths.iter().map(|path| offset(course, path)).collect()
        };
        let paths = course.walk_all(|_| Vector::ZERO, 0.5);
        let start = all(&course, &paths);
        assert!(start.iter().all(|x| x.abs() < 0.2), "at {rate}: {start:?}");
        // Walking on it adds to its speed.
        let paths = course.walk_all(|_| Vector::X * 2.0, 1.0);
        let walked = all(&course, &paths);
        course.jump(4.0);
        let jumps = course.walk_all(|_| Vector::ZERO, 0.5);
        let flown = all(&course, &jumps);
        let ends = course.walk_all(|_| Vector::ZERO, 0.5);
        for (i, (name, _)) in figures.iter().enumerate() {
            let way = walked[i] - start[i];
            assert!((way - 2.0).abs() < 1.0e-3, "{name} at {rate}: {way}");
            assert!(jumps[i].iter().all(|p| p.state.ground == GroundState::InAir), "{name} at {rate}");
            let drift = flown[i] - walked[i];
            assert!(drift.abs() < 1.0e-3, "{name} at {rate}: it flies with the train: {drift}");
            assert!(ends[i].last().expect("it lands").state.is_grounded(), "{name} at {rate}");
        }
        // A stop takes those that stand with it.
        set(&mut course, train, LinearVelocity::ZERO);
        let still = course.walk_all(|_| Vector::ZERO, 0.5);
        for (path, end) in still.iter().zip(&ends) {
            let at = end.last().expect("it stands").position;
            let off = path.iter().find(|p| (p.position - at).length() > 1.0e-4);
            assert!(off.is_none(), "at {rate}: {off:?} from {at}");
        }
    }
}

/// A wheel about the axis of the view, in space a carousel about `up` as well.
#[test]
fn a_carousel_carries_round_exactly() {
    for rate in usual() {
        let mut course = all_at(rate, spin::START + Vector::Y * STANDING);
        let disc = moving(&mut course, spin::disc(), Vector::NEG_Y * 0.5, Vector::ZERO);
        let start = course.walk_all(|_| Vector::ZERO, 0.1);
        set(&mut course, disc, AngularVelocity(spin::velocity(TAU)));
        let paths = course.walk_all(|_| Vector::ZERO, 1.0);
        for (i, (name, _)) in figures().iter().enumerate() {
            let what = (name, rate);
            let path = &paths[i];
            if spin::IS_LEVEL {
                let [from, to] = [&start, &paths].map(|paths| *paths[i].last().expect("it rides"));
                let off = (to.position - from.position).length();
                assert!(off < 1.0e-4, "{what:?}: {off} after a turn");
                assert!(path.iter().all(|p| p.state.is_grounded()), "{what:?}");
                let mut radius = path.iter().map(|p| (p.position - Vector::Y * p.position.y).length());
                assert!(radius.all(|r| (r - spin::START.length()).abs() < 1.0e-4), "{what:?}");
                assert_eq!(to.state.ground_spin, spin::velocity(TAU), "{what:?}");
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
        for &rate in some(&[30, 144]) {
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
        for &rate in some(&[30, 240]) {
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
    for rate in usual() {
        let mut course = all_at(rate, Vector::Y * STANDING);
        floor(&mut course.app);
        let wall = Vector::X * 5.0 + Vector::Y * 2.1;
        fixed(&mut course.app, block(Vector::ONE * 4.0), wall, Rotation::IDENTITY);
        course.walk(Vector::ZERO, 0.1);
        let at = Vector::X * -3.0 + Vector::Y * 2.1;
        let door = moving(&mut course, block(Vector::ONE * 4.0), at, Vector::X * 3.0);
        let figures = figures();
        let mut crushed = vec![None; figures.len()];
        for i in 0..4 * rate / 3 {
            for (k, sample) in course.tick_all().into_iter().enumerate() {
                let door = course.get::<Position>(door).0.x + 2.0;
                let (gap, room) = (sample.position.x - door - 0.4, 3.0 - door);
                let what = (figures[k].0, rate, i);
                if room > 0.8 + 2.2 * SKIN {
                    assert!(gap > SKIN - 3.0e-4, "{what:?}: a gap of {gap}");
                    assert!(!sample.state.is_crushed, "{what:?}: {room} m of room");
                } else if room < 0.78 {
                    crushed[k] = crushed[k].or(Some(sample.state.is_crushed));
                }
            }
        }
        assert!(crushed.iter().all(|crushed| *crushed == Some(true)), "at {rate}: {crushed:?}");
    }
}

/// By the largest force, so heavier crates are slower; none is thrown.
#[test]
fn crates_are_pushed_by_their_mass() {
    let figures = figures();
    let masses = [1.0, 10.0, 100.0, 1000.0];
    for &rate in some(&[30, 60, 144]) {
        let each = figures.iter().flat_map(|(_, shape)| masses.map(|mass| (shape, mass)));
        let starts = each.clone().map(|(shape, _)| (shape.clone(), Vector::Y * STANDING));
        let mut course = Course::side_by_side(rate, starts);
        floor(&mut course.app);
        let mut loads = Vec::new();
        for (i, (_, mass)) in each.enumerate() {
            let at = Position(Vector::X * 1.5 + Vector::Y * 0.5);
            let bundle =
                (RigidBody::Dynamic, block(Vector::ONE), at, Mass(mass), Friction::new(0.4), lane(i));
            loads.push(course.app.world_mut().spawn(bundle).id());
        }
        course.walk(Vector::ZERO, 0.3);
        let mut fastest = vec![0.0; loads.len()];
        for _ in 0..2 * rate {
            course.walk(Vector::X * 2.0, 1.0 / rate as Scalar);
            for (fastest, load) in fastest.iter_mut().zip(&loads) {
                *fastest = Scalar::max(*fastest, course.get::<LinearVelocity>(*load).0.length());
            }
        }
        for (i, (name, _)) in figures.iter().enumerate() {
            let own = masses.len() * i..masses.len() * (i + 1);
            let fastest = &fastest[own.clone()];
            assert!(fastest.iter().all(|v| *v < 3.0), "{name} at {rate}: one flies at {fastest:?} m/s");
            let ways: Vec<Scalar> =
                loads[own].iter().map(|load| course.get::<Position>(*load).0.x - 1.5).collect();
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

/// Rafts of different masses on ice are struck to 5 m/s: a character gets what a raft's mass can give to its
/// own 70 kg, and friction adds g h in each step. A limb that kicks does not throw it, also if it jumps, and
/// a ship takes it along. Teleports take it along whole.
#[test]
fn what_is_struck_below_a_character_gives_it_what_its_mass_can() {
    let cases = each(&[0.7, 7.0, 70.0, 70_000.0]);
    for rate in usual() {
        let starts = cases.iter().map(|(.., shape)| (shape.clone(), Vector::Y * (0.5 + STANDING)));
        let mut course = Course::side_by_side(rate, starts);
        floor(&mut course.app);
        let mut rafts = Vec::new();
        for (i, (_, mass, _)) in cases.iter().enumerate() {
            let shape = block(Vector::X * 6.0 + Vector::Y * -1.5 + Vector::ONE * 2.0);
            let bundle = (RigidBody::Dynamic, shape, Position(Vector::Y * 0.25), Mass(*mass as f32));
            let ice = Friction::ZERO.with_combine_rule(CoefficientCombine::Min);
            rafts.push(course.app.world_mut().spawn((bundle, LockedAxes::ROTATION_LOCKED, ice)).id());
            set(&mut course, rafts[i], lane(i));
        }
        let xs = |samples: Vec<Sample>| -> Vec<Scalar> { samples.iter().map(|s| s.position.x).collect() };
        course.walk(Vector::ZERO, 0.3);
        let start = xs(course.tick_all());
        rafts.iter().for_each(|raft| set(&mut course, *raft, Position(Vector::X * 3.0 + Vector::Y * 0.25)));
        let before = xs(course.tick_all());
        rafts.iter().for_each(|raft| set(&mut course, *raft, LinearVelocity(Vector::X * 5.0)));
        let [first, second] = [0; 2].map(|_| xs(course.tick_all()));
        course.jump(3.0);
        let jumped = course.tick_all();
        for (i, (name, mass, _)) in cases.iter().enumerate() {
            let what = (name, rate, mass);
            assert!(
                (before[i] - start[i] - 3.0).abs() < 1.0e-3,
                "{what:?}: from {} to {}",
                start[i],
                before[i]
            );
            let after = |steps: Scalar| (5.0 * mass / (mass + 70.0) + 9.81 * steps / rate as Scalar).min(5.0);
            let [a, b] = [first[i] - before[i], second[i] - first[i]].map(|way| way * rate as Scalar);
            assert!(
                (a - after(1.0)).abs() < 0.01 * after(1.0),
                "{what:?}: {a} instead of {} m/s",
                after(1.0)
            );
            assert!(
                (b - after(2.0)).abs() < 0.01 * after(2.0),
                "{what:?}: {b} instead of {} m/s",
                after(2.0)
            );
            let flies = jumped[i].state.fall.x;
            assert!((flies - after(2.0)).abs() < 0.01 * after(2.0), "{what:?}: jumps at {flies} m/s");
        }
    }
}
