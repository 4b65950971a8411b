//! One body that touches hundreds of others: most of its contacts have no colour.

use super::dim::sized;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::BodyKind;

/// Number of bodies that the hub touches.
const COUNT: usize = 600;
/// Distance from one to the next, in metres.
const SPACING: f32 = 0.5;

fn hub_half() -> Vector {
    sized(0.5 * SPACING * COUNT as f32 + 1.0, 0.25, 1.0)
}

/// A beam with its middle at a height, and a row of bodies on it: a box, then a ball, and so on. The beam
/// is the first.
fn beam(sim: &mut Sim, height: f32, gap: f32) -> Vec<u32> {
    let hub = sim.cuboid(hub_half(), Vector::Y * height);
    let mut ids = vec![hub];
    for i in 0..COUNT {
        let x = SPACING * (i as f32 - 0.5 * (COUNT as f32 - 1.0));
        let at = Vector::X * x + Vector::Y * (height + 0.45 + gap);
        ids.push(if i % 2 == 0 { sim.cuboid(Vector::ONE * 0.2, at) } else { sim.ball(0.2, at) });
    }
    ids
}

/// A beam on the floor under a row of bodies.
fn loaded(sim: &mut Sim) -> Vec<u32> {
    sim.floor();
    let ids = beam(sim, 0.25, 0.0);
    sim.step();
    ids
}

fn uncolored(sim: &Sim) -> usize {
    sim.colors.overflow().len()
}

fn fastest(sim: &Sim) -> f32 {
    sim.bodies.velocities.iter().map(|v| v.linear.length()).fold(0.0, f32::max)
}

#[test]
fn what_lies_on_a_long_beam_comes_to_rest() {
    // A light beam as well, which has no more mass than what it carries.
    for mass in [1.0, 0.1] {
        let mut sim = Sim::new();
        let ids = loaded(&mut sim);
        sim.load(ids[0], mass);
        let heights: Vec<_> = ids.iter().map(|id| sim.position(*id).y).collect();
        assert!(uncolored(&sim) >= COUNT - 20, "{} contacts without a colour", uncolored(&sim));
        sim.steps(300);
        assert!(fastest(&sim) < 2.0e-3, "{mass}: moves at {} m/s", fastest(&sim));
        for (id, height) in ids.iter().zip(heights) {
            let sunk = height - sim.position(*id).y;
            assert!(sunk.abs() < 0.01, "{mass}: {id} sank by {sunk}");
        }
        assert!(uncolored(&sim) >= COUNT - 20);
    }
}

/// Impulses between a hub and the others balance: bodies thrown onto a free beam keep the sum of momenta, and
/// gain no energy.
#[test]
fn bodies_thrown_onto_a_free_beam_keep_momentum() {
    for mass in [1.0, 0.01] {
        let mut sim = Sim::new();
        sim.gravity = Vector::ZERO;
        let ids = beam(&mut sim, 0.0, 0.02);
        let half = hub_half();
        let weigh = |shape: &Shape| shape.mass_properties(1.0).mass;
        let hub_mass = mass * weigh(&Shape::Cuboid(Cuboid { half }));
        sim.load(ids[0], mass);
        let masses: Vec<f32> = (0..ids.len())
            .map(|i| match i {
                0 => hub_mass,
                _ if i % 2 == 1 => weigh(&Shape::Cuboid(Cuboid { half: Vector::ONE * 0.2 })),
                _ => weigh(&Shape::Ball(Ball { radius: 0.2 })),
            })
            .collect();
        for id in &ids[1..] {
            sim.bodies.velocities[*id as usize].linear = Vector::Y * -2.0 + Vector::X;
        }
        let sum = |sim: &Sim, of: &dyn Fn(Vector) -> f64| -> f64 {
            let each =
                |(id, mass): (&u32, &f32)| f64::from(*mass) * of(sim.bodies.velocities[*id as usize].linear);
            ids.iter().zip(&masses).map(each).sum()
        };
        let before = [sum(&sim, &|v| v.x.into()), sum(&sim, &|v| v.y.into()), sim.energy()];
        let mut most = 0;
        for _ in 0..60 {
            sim.step();
            most = most.max(uncolored(&sim));
        }
        assert!(most >= COUNT - 20, "{most} contacts without a colour");
        let after = [sum(&sim, &|v| v.x.into()), sum(&sim, &|v| v.y.into()), sim.energy()];
        for (before, after) in before.into_iter().zip(after).take(2) {
            assert!((after - before).abs() < 1.0e-4 * before.abs(), "{mass}: {before} became {after} N·s");
        }
        assert!(after[2] <= before[2], "{mass}: energy grew from {} to {}", before[2], after[2]);
    }
}

/// All that outlives a step, as text.
fn state(sim: &Sim) -> String {
    format!("{:?} {:?} {:?} {:?}", sim.bodies, sim.contacts, sim.colors, sim.islands)
}

/// The solution depends neither on workers nor on lanes, and nothing that outlives the step does.
#[test]
fn the_state_after_a_step_does_not_depend_on_workers_or_lanes() {
    let after = |workers: usize, narrow: bool| {
        let mut sim = Sim::new();
        sim.set_workers(workers);
        if narrow {
            sim.set_narrow();
        }
        let ids = loaded(&mut sim);
        sim.load(ids[0], 0.1);
        // A heavy box on a light one, and a ball that bounces.
        let x = hub_half().x + 4.0;
        let heavy = sim.cuboid(Vector::ONE * 0.5, Vector::X * x + Vector::Y * 1.5);
        sim.cuboid(Vector::ONE * 0.5, Vector::X * x + Vector::Y * 0.5);
        sim.load(heavy, 300.0);
        let ball = Shape::Ball(Ball { radius: 0.2 });
        sim.add_with(BodyKind::Dynamic, ball, Vector::Y * 1.5, Rot::IDENTITY, 0.5, 0.8);
        sim.steps(20);
        assert!(uncolored(&sim) >= COUNT - 20);
        state(&sim)
    };
    let alone = after(1, false);
    for (workers, narrow) in [(1, true), (2, false), (4, true), (8, false)] {
        assert!(after(workers, narrow) == alone, "{workers} workers, narrow: {narrow}");
    }
}
