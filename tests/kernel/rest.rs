//! Piles of every shape come to rest.

use super::dim::{BALL_INERTIA, PILES, bullets, hull_of, restless, sized, spin, turned, upright};
use super::extreme::Dice;
use super::sim::Sim;
use super::units::{BINARY, DECIMAL};
use crate::kernel;
use kernel::math::{DIM, Rot, Vector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::BodyKind;

fn shapes() -> Vec<(&'static str, Vec<Shape>)> {
    let slab = Shape::Cuboid(Cuboid { half: sized(0.5, 0.1, 0.3) });
    let kinds = bullets(1.0).into_iter().chain(restless());
    let mut list: Vec<_> = kinds.map(|(name, shape)| (name, vec![shape])).collect();
    list.push(("pointed hull", vec![hull_of(Vector::ONE * 0.5)]));
    list.push(("slab", vec![slab]));
    // A needle at the bottom, with a hundredth of the mass of others, shakes under their load.
    let heavy = list.iter().filter(|(name, _)| *name != "needle");
    let all = heavy.flat_map(|(_, shapes)| shapes.clone()).collect();
    list.push(("mixed", all));
    list
}

/// A pile in a box without a lid, `wide` metres wide, from layers of `wide` bodies along each axis. Seeds
/// differ in the first poses.
fn pile(shapes: &[Shape], wide: usize, count: usize, seed: u64, unit: f32) -> Sim {
    let mut sim = Sim::new();
    sim.unit = unit;
    sim.checked = false;
    sim.sleeping = true;
    let half = 0.5 * wide as f32 + 0.1;
    let high = 60.0;
    for axis in Vector::AXES {
        for side in [-1.0, 1.0] {
            // The floor's top is at 0. The ceiling is out of reach.
            let (middle, inner) = if axis == Vector::Y { (high, high) } else { (0.0, half) };
            let size = Vector::ONE * (half + 2.0) + Vector::Y * high;
            let size = size - axis.scale(size) + axis;
            let place = axis * (middle + side * (inner + 1.0));
            sim.add(BodyKind::Static, Shape::Cuboid(Cuboid { half: size }), place, Rot::IDENTITY);
        }
    }
    let mut dice = Dice::new(seed);
    let layer = wide.pow(DIM as u32 - 1);
    for i in 0..count {
        let place = |k: usize| k as f32 + 0.5 - 0.5 * wide as f32;
        let (x, z) = (place(i % layer % wide), place(i % layer / wide));
        let shift = sized(dice.signed(), dice.signed(), dice.signed()) * 0.05;
        let position = sized(x, 0.6 + 1.1 * (i / layer) as f32, z) + shift;
        let rotation = Rot::IDENTITY.integrated(spin(0.2 * dice.signed()));
        sim.add(BodyKind::Dynamic, shapes[i % shapes.len()].clone(), position, rotation);
    }
    sim
}

fn awake(sim: &Sim) -> usize {
    sim.bodies.awake_dynamic().count()
}

/// Step and substeps, of which a seed takes one.
const RATES: [(f32, u32); 2] = [(1.0 / 60.0, 4), (1.0 / 64.0, 6)];

/// Whether all fall asleep within `limit` seconds; else the fastest speeds.
fn rests(sim: &mut Sim, limit: usize) -> Result<(), String> {
    while (sim.dt * sim.steps_done as f32) < limit as f32 {
        sim.step();
        if awake(sim) == 0 {
            return Ok(());
        }
    }
    let fastest = sim.bodies.awake_dynamic().fold((0.0f32, 0.0f32), |(linear, angular), id| {
        let v = sim.bodies.velocities[id as usize];
        (linear.max(v.linear.length()), angular.max(v.angular.length()))
    });
    Err(format!("{} awake after {limit} s, up to {fastest:?} m/s and rad/s", awake(sim)))
}

#[test]
fn piles_fall_asleep_in_any_length_unit() {
    let (wide, count, _, limit) = PILES[0];
    let mixed = shapes().pop().expect("the last pile is mixed").1;
    let late = |(unit, seed): (f32, u64)| {
        let mut sim = seeded(&mixed, wide, count, seed, unit);
        rests(&mut sim, 2 * limit).err().map(|why| (unit, seed, why))
    };
    let units = DECIMAL.into_iter().chain(BINARY).flat_map(|unit| [0, 1].map(|seed| (unit, seed)));
    let late: Vec<_> = units.filter_map(late).collect();
    assert!(late.is_empty(), "{late:?}");
}

/// A pile of a seed, with the step and substeps of that.
fn seeded(shapes: &[Shape], wide: usize, count: usize, seed: u64, unit: f32) -> Sim {
    let mut sim = pile(shapes, wide, count, seed, unit);
    (sim.dt, sim.substeps) = RATES[(seed % 2) as usize];
    sim
}

/// The seeds of a pile that does not fall asleep in time.
fn late(shapes: &[Shape], wide: usize, count: usize, seeds: u64, limit: usize) -> Vec<(u64, String)> {
    let late =
        |seed: u64| rests(&mut seeded(shapes, wide, count, seed, 1.0), limit).err().map(|why| (seed, why));
    (0..seeds).filter_map(late).collect()
}

/// Prints for docs/design/solver.md when piles of many seeds fall asleep, with infinity for those that take
/// half a minute.
pub fn survey_of_piles() {
    for (name, shapes) in shapes() {
        for ((wide, count, ..), seeds) in PILES.into_iter().zip([40, 20]) {
            let time = |seed| {
                let mut sim = seeded(&shapes, wide, count, seed, 1.0);
                let rested = rests(&mut sim, 30).is_ok();
                if rested { sim.dt * sim.steps_done as f32 } else { f32::INFINITY }
            };
            let mut times: Vec<f32> = (0..seeds).map(time).collect();
            times.sort_by(f32::total_cmp);
            let [middle, last] = [times.len() / 2, times.len() - 1].map(|i| times[i]);
            println!("{count} of {name}: half after {middle:.1} s, all {seeds} seeds after {last:.1} s");
        }
    }
}

/// Of the seeds of a pile, one may take longer, but none twice as long: now and then a body swings or shakes
/// for some seconds between others.
#[test]
fn piles_of_each_shape_fall_asleep() {
    for (name, shapes) in shapes() {
        for (wide, count, seeds, limit) in PILES {
            let slow = late(&shapes, wide, count, seeds, limit);
            assert!(slow.len() <= 1, "{count} of {name}: {slow:?}");
            if !slow.is_empty() {
                let restless = late(&shapes, wide, count, seeds, 2 * limit);
                assert!(restless.is_empty(), "{count} of {name}: {restless:?}");
            }
        }
    }
}

#[test]
fn four_balls_in_a_box_fall_asleep() {
    let ball = [Shape::Ball(Ball { radius: 0.5 })];
    let late = late(&ball, 2, 4, 40, 8);
    assert!(late.is_empty(), "{late:?}");
}

#[test]
fn a_body_that_slides_slowly_stays_awake() {
    let mut sim = Sim::new();
    sim.sleeping = true;
    let ground = Shape::Cuboid(Cuboid { half: Vector::ONE * 50.0 });
    sim.add_with(BodyKind::Static, ground, Vector::Y * -50.0, Rot::IDENTITY, 0.0, 0.0);
    let ball = Shape::Ball(Ball { radius: 0.5 });
    let ball = sim.add_with(BodyKind::Dynamic, ball, Vector::Y * 0.5, Rot::IDENTITY, 0.0, 0.0);
    sim.bodies.velocities[ball as usize].linear = Vector::X * 0.17;
    sim.steps(600);
    assert!(sim.bodies[ball].awake, "it moves at 0.17 m/s");
    let way = sim.position(ball).to_local().x;
    assert!((way - 1.7).abs() < 0.01, "{way} m in 10 s");
}

/// The limit of rolling resistance had grown with the radius of the ground.
#[test]
fn issue_a_ball_stuck_to_the_slope_of_a_boulder() {
    let (boulder, radius, slope) = (50.0, 0.5, 11.0f32.to_radians());
    let mut sim = Sim::new();
    let center = Vector::Y * -boulder;
    sim.add(BodyKind::Static, Shape::Ball(Ball { radius: boulder }), center, Rot::IDENTITY);
    let start = center + turned(-slope).rotate(Vector::Y) * (boulder + radius);
    let ball = sim.ball(radius, start);
    sim.steps(60);
    let drop = start.y - sim.position(ball).to_local().y;
    let v = sim.bodies.velocities[ball as usize].linear.length();
    // m g drop = ½ m v² (1 + I / m r²), but for what is lost while the ball is slower than 0.4 m/s.
    let expected = (2.0 * 10.0 * drop / (1.0 + BALL_INERTIA)).sqrt();
    assert!(v > 1.0 && (v - expected).abs() < 0.02 * expected, "{v} m/s of {expected} after 1 s");
}

#[test]
fn issue_a_ball_that_spun_on_the_spot_never_stopped() {
    let Some(axis) = upright() else { return };
    let mut sim = Sim::new();
    sim.floor();
    let ball = sim.ball(0.5, Vector::Y * 0.5);
    sim.steps(10);
    sim.bodies.velocities[ball as usize].angular = axis;
    sim.steps(600);
    assert!(sim.bodies.velocities[ball as usize].angular.length() < 1.0e-3, "after 10 s");
}

#[test]
fn a_ball_at_walking_speed_rolls_on() {
    let mut sim = Sim::new();
    sim.floor();
    let ball = sim.ball(0.5, Vector::Y * 0.5);
    sim.steps(10);
    let rolling = (Vector::X, spin(-2.0));
    let v = &mut sim.bodies.velocities[ball as usize];
    (v.linear, v.angular) = rolling;
    sim.steps(600);
    let v = sim.bodies.velocities[ball as usize];
    assert!((v.linear - rolling.0).length() < 1.0e-3, "10 s at 1 m/s: {v:?}");
}

#[test]
fn a_slow_ball_rolls_to_a_stop() {
    let mut sim = Sim::new();
    sim.floor();
    let ball = sim.ball(0.5, Vector::Y * 0.5);
    sim.steps(10);
    let v = &mut sim.bodies.velocities[ball as usize];
    (v.linear, v.angular) = (Vector::X * 0.1, spin(-0.2));
    // The lever is a hundredth of the radius, at friction 0.6: 0.006 g brake the ball and its rotation.
    let expected = 0.5 * 0.1 * 0.1 / (0.06 / (1.0 + BALL_INERTIA));
    sim.steps(240);
    let rolled = sim.position(ball).to_local().x;
    assert!((rolled - expected).abs() < 0.02 * expected, "{rolled} m of {expected}");
}

/// The arm of a static body had counted, which is short over the middle of a slab.
#[test]
fn issue_a_ball_was_braked_over_the_middle_of_thin_slabs() {
    let mut sim = Sim::new();
    for i in 0..12 {
        let slab = Shape::Cuboid(Cuboid { half: sized(0.5, 0.01, 0.5) });
        sim.add(BodyKind::Static, slab, sized(i as f32, -0.01, 0.0), Rot::IDENTITY);
    }
    let ball = sim.ball(0.5, Vector::Y * 0.5);
    sim.steps(10);
    let v = &mut sim.bodies.velocities[ball as usize];
    (v.linear, v.angular) = (Vector::X, spin(-2.0));
    sim.steps(600);
    let v = sim.bodies.velocities[ball as usize].linear;
    assert!((v - Vector::X).length() < 1.0e-3, "10 s at 1 m/s: {v:?}");
}

#[test]
fn issue_a_ball_with_high_friction_stuck_to_a_steep_slope() {
    let mut sim = Sim::new();
    sim.gravity = sized(7.0, -7.0, 0.0);
    let ground = Shape::Cuboid(Cuboid { half: sized(50.0, 1.0, 50.0) });
    sim.add_with(BodyKind::Static, ground, -Vector::Y, Rot::IDENTITY, 100.0, 0.0);
    let ball = Shape::Ball(Ball { radius: 0.5 });
    let ball = sim.add_with(BodyKind::Dynamic, ball, Vector::Y * 0.5, Rot::IDENTITY, 100.0, 0.0);
    sim.steps(60);
    let (v, expected) = (sim.bodies.velocities[ball as usize].linear.x, 7.0 / (1.0 + BALL_INERTIA));
    assert!((v - expected).abs() < 0.02 * expected, "{v} m/s of {expected} after 1 s");
}
