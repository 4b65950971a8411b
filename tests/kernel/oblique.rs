//! Oblique bounces with friction, and what strikes several walls at once.

use super::blows::{CLOCKS, clocked, cuboid, phases};
use super::dim::{any_rotation, any_spin, cylinder, sized, terrain};
use super::extreme::Dice;
use crate::kernel;
use kernel::math::{DIM, Rot, Vector};
use kernel::shape::{Ball, Capsule, HalfSpace, Shape};
use kernel::table::{BodyKind, Velocity};

/// The most energy of a body that bounces off a ground, as a share of that before.
fn bounced(ground: &Shape, shape: &Shape, clock: (f32, u32), surface: [f32; 2], seed: u64) -> f64 {
    let mut dice = Dice::new(seed);
    let mut sim = clocked(clock);
    sim.gravity = Vector::ZERO;
    let [friction, e] = surface;
    sim.add_with(BodyKind::Static, ground.clone(), Vector::ZERO, Rot::IDENTITY, friction, e);
    let rotation = any_rotation(&mut dice);
    let low = -shape.local_aabb(rotation).min.y;
    let at = sized(0.13, low + 0.05 + 0.1 * dice.unit(), 0.21);
    let id = sim.add_with(BodyKind::Dynamic, shape.clone(), at, rotation, friction, e);
    let linear = sized(6.0 * dice.signed(), -3.0 - 3.0 * dice.unit(), 6.0 * dice.signed());
    sim.bodies.set_velocity(id, Velocity { linear, angular: any_spin(&mut dice) * 5.0 });
    let start = sim.energy();
    (0..(0.5 * clock.0) as usize).fold(0.0, |most: f64, _| {
        sim.step();
        most.max(sim.energy() / start)
    })
}

#[test]
fn oblique_elastic_bounces_gain_no_energy() {
    let grounds = [Shape::HalfSpace(HalfSpace { normal: Vector::Y }), terrain(0.5, |_, _| 0.0)];
    let ends = [-0.3, 0.3].map(|x| Vector::X * x);
    let shapes = [
        ("box", cuboid(Vector::ONE * 0.2)),
        ("plank", cuboid(sized(0.5, 0.05, 0.2))),
        ("ball", Shape::Ball(Ball { radius: 0.2 })),
        ("capsule", Shape::Capsule(Capsule { a: ends[0], b: ends[1], radius: 0.1 })),
        ("cylinder", cylinder(0.3, 0.1)),
    ];
    let (mut bad, mut count) = (Vec::new(), 0);
    for (floor, ground) in grounds.iter().enumerate() {
        for (name, shape) in &shapes {
            for clock in CLOCKS {
                for surface in [[0.3, 1.0], [1.0, 1.0], [0.5, 0.8]] {
                    for seed in 0..40 {
                        count += 1;
                        let share = bounced(ground, shape, clock, surface, seed);
                        if !(share < 1.005) {
                            bad.push((
                                share,
                                format!("{name}, floor {floor}, {clock:?}, {surface:?}, seed {seed}"),
                            ));
                        }
                    }
                }
            }
        }
    }
    bad.sort_by(|a, b| b.0.total_cmp(&a.0));
    assert!(bad.is_empty(), "{} of {count}: {:#?}", bad.len(), &bad[..bad.len().min(30)]);
}

/// Both walls stop a body at once, and each brakes it along the other by friction.
///
/// The normal impulse N of each wall and the friction μ N of the other stop 5 m/s: N (1 + μ) = 5 m. Then each
/// wall returns e N, and the friction of the other, now against the rebound, takes μ e N of it: e (1 - μ) /
/// (1 + μ) of the speed is left.
#[test]
fn a_corner_returns_the_same_along_both_walls() {
    let (friction, e) = (0.5, 0.8);
    let want = 5.0 * e * (1.0 - friction) / (1.0 + friction);
    let mut bad = Vec::new();
    for (name, shape, foot) in
        [("ball", Shape::Ball(Ball { radius: 0.25 }), 0.25), ("box", cuboid(Vector::ONE * 0.25), 0.25)]
    {
        for clock in CLOCKS {
            for (first, second) in [(Vector::X, Vector::Y), (Vector::Y, Vector::X)] {
                let error = |v: Vector| (v - (Vector::X + Vector::Y) * want).length();
                let mut worst = (Vector::X + Vector::Y) * want;
                for phase in phases() {
                    let mut sim = clocked(clock);
                    sim.gravity = Vector::ZERO;
                    for normal in [first, second] {
                        let wall = Shape::HalfSpace(HalfSpace { normal });
                        sim.add_with(BodyKind::Static, wall, Vector::ZERO, Rot::IDENTITY, friction, e);
                    }
                    let place = foot + (1.0 + phase) * 5.0 * sim.dt;
                    let at = (Vector::X + Vector::Y) * place;
                    let id = sim.add_with(BodyKind::Dynamic, shape.clone(), at, Rot::IDENTITY, friction, e);
                    let linear = (Vector::X + Vector::Y) * -5.0;
                    sim.bodies.set_velocity(id, Velocity { linear, ..Velocity::default() });
                    sim.steps(6);
                    let v = sim.bodies.velocities[id as usize].linear;
                    if error(v) >= error(worst) {
                        worst = v;
                    }
                }
                // Impulses of both walls rise in eight steps, each with one wall first.
                let speed = worst.length() / (want * 2.0f32.sqrt());
                if error(worst) > 0.08 * want || (speed - 1.0).abs() > 0.03 {
                    bad.push(format!("{name}, {clock:?}, {first:?} first: {worst:?}, not {want}"));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{DIM}D: {bad:#?}");
}
