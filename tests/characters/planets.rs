//! Planets: characters that walk once around.

use super::{Course, SKIN, ball, each, terrain, toward, turned, usual};
use avian::{math::*, prelude::*, schedule::PhysicsSchedule};
use bevy_ecs::prelude::*;

const RADIUS: Scalar = 3.0;

/// How far below a ball the middle of a segment of a surface of 64 is, and a little more.
const DEPTH: Scalar = 5.0e-3;

/// From the centre of the planet to that of a figure.
const STANDING: Scalar = RADIUS + 0.9 + SKIN;

const SPEED: Scalar = 6.0;

fn angle_of(position: Vector) -> Scalar {
    position.x.atan2(position.y)
}

/// The speed of the walkers in m/s.
#[derive(Resource)]
struct Pace(Scalar);

/// Stands each walker upright, and leads it on clockwise, as its game does.
fn lead_round(
    mut walkers: Query<(&Position, &mut Rotation, &mut CharacterController, &mut CharacterInput)>,
    pace: Res<Pace>,
) {
    for (position, mut rotation, mut controller, mut input) in &mut walkers {
        let angle = angle_of(position.0);
        *rotation = turned(-angle);
        controller.up = Dir::new(position.0.normalize().f32()).expect("a direction");
        input.velocity = toward(-angle as f32) * pace.0;
    }
}

/// A surface of 64 segments.
fn faceted() -> Collider {
    let corner = |i: u32| {
        let angle = TAU * i as Scalar / 64.0;
        (Vector::X * angle.sin() + Vector::Y * angle.cos()) * RADIUS
    };
    terrain(&(0..=64).map(corner).collect::<Vec<_>>())
}

/// On a ball and on a surface of segments, at the speed asked for, and without leaving the ground.
#[test]
fn a_planet_is_walked_around() {
    let cases = each(&["ball", "facets"]);
    for rate in usual() {
        let starts = cases.iter().map(|(.., shape)| (shape.clone(), Vector::Y * STANDING));
        let mut course = Course::side_by_side(rate, starts);
        for (i, (_, planet, _)) in cases.iter().enumerate() {
            let planet = if *planet == "ball" { ball(RADIUS) } else { faceted() };
            course.fix_in_lane(i, planet, Vector::ZERO, Rotation::IDENTITY);
        }
        course.app.add_systems(PhysicsSchedule, lead_round.before(CharacterSystems));
        course.app.insert_resource(Pace(0.0));
        let before = course.walk_all(|_| Vector::ZERO, 0.2);
        course.app.insert_resource(Pace(SPEED));
        // In a tick it walks straight on, and so a little less than an arc of that length.
        let turn = (SPEED / rate as Scalar / STANDING).atan();
        let ticks = (TAU / turn).ceil();
        // It turns upright in the next tick: a foot that leans by the turn stands as much lower or higher.
        let leaning = STANDING * (1.0 - turn.cos());
        let mut angles: Vec<_> = before.iter().map(|path| angle_of(path[path.len() - 1].position)).collect();
        let mut turned = vec![0.0; cases.len()];
        for tick in 0..ticks as u32 {
            for (i, sample) in course.tick_all().into_iter().enumerate() {
                let what = (cases[i].0, cases[i].1, rate, tick);
                assert!(sample.state.is_grounded(), "{what:?}: {sample:?}");
                let height = sample.position.length() - STANDING;
                let depth = if cases[i].1 == "ball" { 0.0 } else { DEPTH };
                let error = 5.0e-4 + leaning;
                assert!(height > -depth - error && height < error, "{what:?}: {height} m off the ground");
                let angle = angle_of(sample.position);
                turned[i] += (angle - angles[i]).rem_euclid(TAU);
                angles[i] = angle;
            }
        }
        course.app.insert_resource(Pace(0.0));
        let stood = course.walk_all(|_| Vector::ZERO, 0.1);
        course.jump(3.0);
        let jumps = course.walk_all(|_| Vector::ZERO, 0.7);
        for (i, (name, planet, _)) in cases.iter().enumerate() {
            let what = (name, planet, rate);
            let off = (turned[i] - ticks * turn).abs() * STANDING;
            // The angle of a step is that at another height.
            let height = leaning + if *planet == "ball" { 0.0 } else { DEPTH };
            assert!(off < 0.01 + TAU * height, "{what:?}: {off} m off after a turn of {} m", STANDING * TAU);
            // A jump goes straight up, and ends on the ground below.
            let start = stood[i].last().expect("it stands").position;
            let top = jumps[i].iter().map(|p| p.position.length() - start.length()).fold(0.0, Scalar::max);
            let missed = 0.5 * 9.81 * (0.5 / rate as Scalar).powi(2);
            let height = 9.0 / (2.0 * 9.81);
            assert!(top < height + 5.0e-4 && top > height - missed - 5.0e-4, "{what:?}: {top}");
            let end = jumps[i].last().expect("it lands");
            assert!(end.state.is_grounded(), "{what:?}: {end:?}");
            assert!((end.position - start).length() < 1.0e-3, "{what:?}: {end:?} from {start}");
        }
    }
}
