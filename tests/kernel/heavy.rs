//! Heavy bodies on light ones.

use super::sim::Sim;
use crate::kernel;
use kernel::math::{DIM, Scalar, Vector};

/// A tower of unit boxes with a box of the given side on top that is `ratio` times as heavy as one of them.
fn tower(ratio: f32, side: f32) -> (Sim, Vec<u32>) {
    let mut sim = Sim::new();
    sim.floor();
    let mut ids: Vec<u32> =
        (0..5).map(|i| sim.cuboid(Vector::ONE * 0.5, Vector::Y * (0.5 + i as f32))).collect();
    let top = sim.cuboid(Vector::ONE * (0.5 * side), Vector::Y * (5.0 + 0.5 * side));
    sim.load(top, ratio / side.powi(DIM as i32));
    ids.push(top);
    (sim, ids)
}

/// The fastest of some bodies, m/s.
fn fastest(sim: &Sim, ids: &[u32]) -> f32 {
    ids.iter().map(|id| sim.bodies.velocities[*id as usize].linear.length()).fold(0.0, f32::max)
}

/// A box of 1,000 kg crushed a tower of boxes of 1 kg, and one of 100 kg sank by 0.14 m.
#[test]
fn a_heavy_box_on_a_tower_of_light_ones_stands() {
    for (ratio, allowed) in [(1.0, 0.01), (10.0, 0.05), (100.0, 0.1), (1000.0, 0.2)] {
        for side in [1.0, 2.0, 4.0] {
            let (mut sim, ids) = tower(ratio, side);
            let top = ids[5];
            let start = sim.position(top).y;
            let (mut deepest, mut speed): (Scalar, f32) = (0.0, 0.0);
            for step in 0..1200 {
                sim.step();
                deepest = deepest.max(start - sim.position(top).y);
                if step >= 600 {
                    speed = speed.max(fastest(&sim, &ids));
                }
            }
            let case = format!("{ratio} : 1, {side} m");
            assert!(deepest <= allowed, "{case}: sank by {deepest} m");
            assert!(speed < 0.02, "{case}: moves at {speed} m/s after 10 s");
            let leans = (sim.position(top) - Vector::Y.to_world() * sim.position(top).y).length();
            assert!(leans < 0.15, "{case}: leans by {leans} m");
        }
    }
}

/// What carries a load has its own mass again when the load is gone: it is pushed as any other box.
#[test]
fn a_box_that_bore_a_load_has_its_own_mass_when_the_load_is_gone() {
    let (mut sim, ids) = tower(1000.0, 1.0);
    sim.steps(120);
    sim.remove(ids[5]);
    sim.steps(120);
    sim.gravity = Vector::ZERO;
    // A box of the same mass hits the top box in the middle: the pair goes on with half the speed.
    let y = sim.position(ids[4]).y as f32;
    let hammer = sim.cuboid(Vector::ONE * 0.4, Vector::Y * y - Vector::X * 3.0);
    sim.load(hammer, 0.8f32.powi(-(DIM as i32)));
    sim.bodies.velocities[hammer as usize].linear = Vector::X * 4.0;
    sim.steps(60);
    let speeds = [hammer, ids[4]].map(|id| sim.bodies.velocities[id as usize].linear.x);
    assert!((speeds[0] + speeds[1] - 4.0).abs() < 0.1, "momentum is kept: {speeds:?}");
}

/// Blows through light bodies give none of them more mass.
#[test]
fn blows_between_bodies_of_unequal_mass_keep_momentum() {
    let mut sim = Sim::new();
    sim.gravity = Vector::ZERO;
    let masses = [1000.0f32, 1.0, 1.0, 300.0, 1.0, 50.0];
    let mut ids = Vec::new();
    for (i, mass) in masses.into_iter().enumerate() {
        let id = sim.cuboid(Vector::ONE * 0.5, Vector::X * (1.05 * i as f32));
        sim.load(id, mass);
        ids.push(id);
    }
    sim.bodies.velocities[ids[0] as usize].linear = Vector::X * 3.0;
    let momentum = |sim: &Sim| -> f32 {
        ids.iter().zip(masses).map(|(id, mass)| mass * sim.bodies.velocities[*id as usize].linear.x).sum()
    };
    let before = momentum(&sim);
    sim.steps(240);
    let after = momentum(&sim);
    assert!((after - before).abs() < 1.0e-5 * before, "{before} became {after} N·s");
}
