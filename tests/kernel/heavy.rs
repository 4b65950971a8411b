//! Heavy bodies on light ones.

use super::blows::{CLOCKS, clocked, cuboid, on_floor, phases};
use super::dim::{sized, spin_momentum, turned};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{DIM, Rot, Scalar, Vector};
use kernel::table::{BodyKind, Velocity};

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
            for step in 0..2400 {
                sim.step();
                deepest = deepest.max(start - sim.position(top).y);
                if step >= 1800 {
                    speed = speed.max(fastest(&sim, &ids));
                }
            }
            let case = format!("{ratio} : 1, {side} m");
            assert!(deepest <= allowed, "{case}: sank by {deepest} m");
            // Light boxes have their own mass sideways: 1,000 kg sway on them by some centimetres at first.
            assert!(speed < 0.01, "{case}: moves at {speed} m/s after 30 s");
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

/// A box of a mass in kg.
fn weight(sim: &mut Sim, half: Vector, at: Vector, kg: f32, friction: f32) -> u32 {
    let shape = cuboid(half);
    let id = sim.add_with(BodyKind::Dynamic, shape.clone(), at, Rot::IDENTITY, friction, 0.0);
    sim.load(id, kg / shape.mass_properties(1.0).mass);
    id
}

/// A hammer of 1 kg at 4 m/s strikes the third of five boxes of 1 kg that bear a load and stand on ice.
#[test]
fn a_blow_on_a_loaded_tower_keeps_momentum() {
    let mut bad = Vec::new();
    for clock in CLOCKS {
        for load in [100.0f32, 1000.0] {
            // At 30 Hz the ice lets the lowest box slip out.
            if load > 100.0 && clock.0 < 60.0 {
                continue;
            }
            let mut sim = on_floor("one box", clock, 0.0, 0.0).expect("both dimensions have it");
            let half = Vector::ONE * 0.5;
            let mut ids = Vec::new();
            for k in 0..6 {
                let (kg, friction) = (if k < 5 { 1.0 } else { load }, if k > 0 { 0.5 } else { 0.0 });
                ids.push(weight(&mut sim, half, Vector::Y * (0.5 + k as f32), kg, friction));
            }
            sim.steps(2 * clock.0 as usize);
            let momentum = |sim: &Sim, ids: &[u32]| -> f64 {
                ids.iter()
                    .map(|id| sim.mass(*id) * f64::from(sim.bodies.velocities[*id as usize].linear.x))
                    .sum()
            };
            let before = momentum(&sim, &ids);
            let y = sim.position(ids[2]).to_local().y;
            let at = sized(-0.9 - 4.2 / clock.0, y, 0.0);
            ids.push(weight(&mut sim, Vector::ONE * 0.3, at, 1.0, 0.5));
            sim.bodies.set_velocity(ids[6], Velocity { linear: Vector::X * 4.0, ..Velocity::default() });
            sim.steps((0.25 * clock.0) as usize);
            let gained = momentum(&sim, &ids) - before;
            if (gained / 4.0 - 1.0).abs() > 0.02 {
                bad.push(format!("{clock:?}, {load} kg: 4 became {gained} N·s"));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// Angular momentum of bodies about the origin, in N·m·s, and the torque of gravity on them in N·m.
fn turning(sim: &Sim, ids: &[u32]) -> (f64, f64) {
    ids.iter().fold((0.0, 0.0), |(momentum, torque), id| {
        let (mass, v) = (sim.mass(*id), sim.bodies.velocities[*id as usize]);
        let pose = sim.bodies.poses[*id as usize];
        let (at, linear) = (pose.center.to_local(), v.linear);
        let orbit = mass * f64::from(at.x * linear.y - at.y * linear.x);
        let spin = spin_momentum(sim.masses[*id as usize].1, pose.rotation, v.angular);
        let weight = mass * f64::from(sim.gravity.y);
        (momentum + orbit + f64::from(spin.z), torque + weight * f64::from(at.x))
    })
}

/// A box of 20 kg drops at 3 m/s on one of two weights of 100 kg on a seesaw of 1 kg: what bears the plank
/// has no arm, so only gravity changes the angular momentum.
#[test]
fn a_blow_on_a_seesaw_keeps_angular_momentum() {
    let mut bad = Vec::new();
    // At 30 Hz the plank bears too much in a substep: docs/design/limits.md.
    for clock in CLOCKS.into_iter().filter(|clock| clock.0 >= 60.0) {
        let mut sim = clocked(clock);
        let (edge, eighth) = (cuboid(sized(0.5, 0.5, 1.0)), core::f32::consts::FRAC_PI_4);
        let below = Vector::Y * -0.5 * core::f32::consts::SQRT_2;
        sim.add_with(BodyKind::Static, edge, below, turned(eighth), 0.5, 0.0);
        let half = Vector::ONE * 0.3;
        let mut ids = vec![weight(&mut sim, sized(2.0, 0.1, 0.5), Vector::Y * 0.1, 1.0, 0.5)];
        for x in [-1.5, 1.5] {
            ids.push(weight(&mut sim, half, sized(x, 0.5, 0.0), 100.0, 0.5));
        }
        sim.steps(clock.0 as usize / 2);
        let top = sim.position(ids[1]).to_local().y;
        for phase in phases() {
            let (mut sim, mut ids) = (sim.clone(), ids.clone());
            let at = sized(-1.5, top + 0.6 + 3.0 / clock.0 * (0.1 + phase), 0.0);
            ids.push(weight(&mut sim, half, at, 20.0, 0.5));
            sim.bodies.set_velocity(ids[3], Velocity { linear: Vector::Y * -3.0, ..Velocity::default() });
            let (before, mut torque) = turning(&sim, &ids);
            let mut expected = before;
            for _ in 0..(0.1 * clock.0) as usize {
                expected += torque * f64::from(sim.dt);
                sim.step();
                torque = turning(&sim, &ids).1;
            }
            let after = turning(&sim, &ids).0;
            if (after - expected).abs() > 0.02 * 90.0 {
                bad.push(format!("{clock:?}, phase {phase}: {before} became {after}, not {expected} N·m·s"));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}
