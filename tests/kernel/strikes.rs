//! Impacts that pass through several bodies: a break shot, rows, and racks.

use super::blows::{CLOCKS, clocked, cuboid, phases};
use super::dim::sized;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, HalfSpace, Shape};
use kernel::table::{BodyKind, Velocity};

const RADIUS: f32 = 0.25;
/// In m/s. At 5 m/s one ball of the rack closes at exactly the speed of a blow, and rounding would decide.
const SPEED: f32 = 5.3;

/// Bodies of one shape, some of which move along x, in a world without gravity. The ids are by place, or in
/// reverse order.
fn thrown(
    clock: (f32, u32),
    shape: &Shape,
    bodies: &[(Vector, f32)],
    surface: [f32; 2],
    is_reverse: bool,
) -> (Sim, Vec<u32>) {
    let mut sim = clocked(clock);
    sim.gravity = Vector::ZERO;
    let [friction, e] = surface;
    let mut add = |(at, speed): &(Vector, f32)| {
        let id = sim.add_with(BodyKind::Dynamic, shape.clone(), *at, Rot::IDENTITY, friction, e);
        sim.bodies.set_velocity(id, Velocity { linear: Vector::X * *speed, ..Velocity::default() });
        id
    };
    let ids = if is_reverse {
        let mut ids: Vec<u32> = bodies.iter().rev().map(&mut add).collect();
        ids.reverse();
        ids
    } else {
        bodies.iter().map(&mut add).collect()
    };
    (sim, ids)
}

/// The velocities of bodies as shares of [`SPEED`].
fn shares(sim: &Sim, ids: &[u32]) -> Vec<Vector> {
    ids.iter().map(|id| sim.bodies.velocities[*id as usize].linear * (1.0 / SPEED)).collect()
}

/// The way of a striker to its first contact: one step and a part of the next.
fn run_up(clock: (f32, u32), phase: f32) -> f32 {
    (1.0 + phase) * SPEED / clock.0
}

fn ball() -> Shape {
    Shape::Ball(Ball { radius: RADIUS })
}

/// By symmetry each of two takes J along a line at 30° to the way: v' = v - 2 J cos 30° / m, and e = 1 wants
/// J / m - v' cos 30° = v cos 30°. So J / m = 2 v cos 30° / (1 + 2 cos² 30°): 0.6 v along the line for each,
/// and -0.2 v is left.
#[test]
fn a_ball_that_strikes_two_at_once_gives_each_the_same() {
    let mut bad = Vec::new();
    for clock in CLOCKS {
        for is_reverse in [false, true] {
            let mut worst = [0.0f32; 2];
            for phase in phases() {
                let far = RADIUS * 3.0f32.sqrt();
                let bodies = [
                    (Vector::X * -run_up(clock, phase), SPEED),
                    (sized(far, RADIUS, 0.0), 0.0),
                    (sized(far, -RADIUS, 0.0), 0.0),
                ];
                let (mut sim, ids) = thrown(clock, &ball(), &bodies, [0.0, 1.0], is_reverse);
                sim.steps(6);
                let v = shares(&sim, &ids);
                let errors = [v[0].x + 0.2, v[1].x - 0.6, v[2].x - 0.6];
                let skew = [v[1].x - v[2].x, v[1].y + v[2].y, v[0].y];
                worst[0] = errors.into_iter().fold(worst[0], |most, error| most.max(error.abs()));
                worst[1] = skew.into_iter().fold(worst[1], |most, error| most.max(error.abs()));
            }
            if worst[0] > 0.01 || worst[1] > 1.0e-3 {
                bad.push(format!(
                    "{clock:?}, reverse {is_reverse}: off by {}, skew by {}",
                    worst[0], worst[1]
                ));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// As many leave a row at the end as strike it, one after the other or all at once.
fn assert_row_passes_on(name: &str, shape: &Shape, count: usize) {
    let mut bad = Vec::new();
    for clock in CLOCKS {
        for (gap, movers, is_reverse) in
            [(0.0, 1, false), (0.0, 1, true), (0.0, 2, false), (1.0e-3, 1, false), (1.0e-3, 2, true)]
        {
            let mut worst = 0.0f32;
            for phase in phases() {
                let start = |k: usize| {
                    let ahead = if k < movers { run_up(clock, phase) } else { 0.0 };
                    let speed = if k < movers { SPEED } else { 0.0 };
                    (Vector::X * ((2.0 * RADIUS + gap) * k as f32 - ahead), speed)
                };
                let bodies: Vec<_> = (0..count).map(start).collect();
                let (mut sim, ids) = thrown(clock, shape, &bodies, [0.0, 1.0], is_reverse);
                sim.steps(8);
                for (k, v) in shares(&sim, &ids).into_iter().enumerate() {
                    let want = if k + movers >= count { 1.0 } else { 0.0 };
                    worst = worst.max((v - Vector::X * want).length());
                }
            }
            if worst > 0.05 {
                bad.push(format!(
                    "{name}, {clock:?}, {gap} m apart, {movers} in, reverse {is_reverse}: off by {worst}"
                ));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

#[test]
fn as_many_balls_leave_a_cradle_as_strike_it() {
    assert_row_passes_on("balls", &ball(), 5);
}

#[test]
fn as_many_boxes_leave_a_row_as_strike_it() {
    assert_row_passes_on("boxes", &cuboid(Vector::ONE * RADIUS), 6);
}

/// A ball that strikes the tip of a triangle of 15, and its mirror images: of each ball the index of the one
/// across the line.
fn rack(clock: (f32, u32), phase: f32) -> (Vec<(Vector, f32)>, Vec<usize>) {
    let mut bodies = vec![(Vector::X * -(2.0 * RADIUS + run_up(clock, phase)), SPEED)];
    let mut mirror = vec![0];
    for row in 0..5 {
        let first = bodies.len();
        for k in 0..=row {
            let x = RADIUS * 3.0f32.sqrt() * row as f32;
            bodies.push((sized(x, RADIUS * (2 * k - row) as f32, 0.0), 0.0));
            mirror.push(first + (row - k) as usize);
        }
    }
    (bodies, mirror)
}

/// How a break of the rack went, as shares of the speed, its momentum or its energy.
struct Break {
    velocities: Vec<Vector>,
    momentum: f32,
    energy: f64,
    skew: f32,
}

fn broken(clock: (f32, u32), phase: f32, surface: [f32; 2], is_reverse: bool) -> Break {
    let (bodies, mirror) = rack(clock, phase);
    let (mut sim, ids) = thrown(clock, &ball(), &bodies, surface, is_reverse);
    let (start, mut energy) = (sim.energy(), 0.0f64);
    for _ in 0..8 {
        sim.step();
        energy = energy.max(sim.energy() / start);
    }
    let velocities = shares(&sim, &ids);
    let sum = velocities.iter().fold(Vector::ZERO, |sum, v| sum + *v);
    let skew = (0..ids.len()).map(|k| {
        let (v, image) = (velocities[k], velocities[mirror[k]]);
        (v - image + Vector::Y * (2.0 * image.y)).length()
    });
    let skew = skew.fold(0.0, f32::max);
    Break { momentum: (sum - Vector::X).length(), velocities, energy, skew }
}

#[test]
fn a_rack_keeps_momentum_energy_and_symmetry() {
    let mut bad = Vec::new();
    for clock in CLOCKS {
        for surface in [[0.0, 1.0], [0.5, 0.0], [0.5, 0.5]] {
            let (mut momentum, mut energy, mut skew, mut order) = (0.0f32, 0.0f64, 0.0f32, 0.0f32);
            for phase in phases() {
                let [first, second] = [false, true].map(|reverse| broken(clock, phase, surface, reverse));
                for it in [&first, &second] {
                    momentum = momentum.max(it.momentum);
                    energy = energy.max(it.energy);
                    skew = skew.max(it.skew);
                }
                let apart = first.velocities.iter().zip(&second.velocities).map(|(a, b)| (*a - *b).length());
                order = apart.fold(order, f32::max);
            }
            // With friction, contacts of several bodies have no unique impulses.
            let most = if surface[0] > 0.0 { 0.03 } else { 0.01 };
            if momentum > 1.0e-4 || energy > 1.0005 || skew > most || order > most {
                bad.push(format!(
                    "{clock:?}, friction and e {surface:?}: momentum off by {momentum}, {energy} of the \
                     energy, skew by {skew}, by the order {order}"
                ));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// Impulses of both walls cancel each other for the most part. If the walls returned different shares of
/// them, the ball would leave at many times its speed.
#[test]
fn a_ball_in_a_wedge_of_two_restitutions_gains_no_energy() {
    for (clock, phase) in CLOCKS.into_iter().flat_map(|clock| phases().map(move |phase| (clock, phase))) {
        for (half_angle, friction) in [(0.05f32, 0.0), (0.2, 0.0), (0.2, 0.5), (0.8, 0.3)] {
            let mut sim = clocked(clock);
            sim.gravity = Vector::ZERO;
            for (side, e) in [(-1.0, 0.9), (1.0, 0.0)] {
                let normal = sized(half_angle.sin(), side * half_angle.cos(), 0.0);
                let wall = Shape::HalfSpace(HalfSpace { normal });
                sim.add_with(BodyKind::Static, wall, Vector::ZERO, Rot::IDENTITY, friction, e);
            }
            let at = Vector::X * (RADIUS / half_angle.sin() + run_up(clock, phase));
            let id = sim.add_with(BodyKind::Dynamic, ball(), at, Rot::IDENTITY, friction, 0.9);
            let linear = Vector::X * -SPEED;
            sim.bodies.set_velocity(id, Velocity { linear, ..Velocity::default() });
            let start = sim.energy();
            let most = (0..8).fold(0.0f64, |most, _| {
                sim.step();
                most.max(sim.energy() / start)
            });
            assert!(most < 1.001, "{clock:?}, {phase}, {half_angle} rad, friction {friction}: {most}");
        }
    }
}
