//! Sums of impulses over a step are the momentum that bodies gained in it.

use super::dim::sized;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::BodyKind;

/// Balls and boxes without friction that fall on each other, with a coefficient of restitution.
fn heap(restitution: f32, substeps: u32) -> Sim {
    let mut sim = Sim::new();
    sim.substeps = substeps;
    sim.contacts.sum_impulses = true;
    // A sweep that puts a body back changes its velocity without an impulse.
    sim.sweeps = false;
    let half = Vector::ONE * 200.0;
    let floor = Shape::Cuboid(Cuboid { half });
    sim.add_with(BodyKind::Static, floor, Vector::Y * -200.0, Rot::IDENTITY, 0.0, restitution);
    for i in 0..24 {
        let place = sized((i % 4) as f32 * 0.9, 1.0 + i as f32 * 0.6, (i % 3) as f32 * 0.7);
        let shape = match i % 2 {
            0 => Shape::Ball(Ball { radius: 0.5 }),
            _ => Shape::Cuboid(Cuboid { half: Vector::ONE * 0.4 }),
        };
        sim.add_with(BodyKind::Dynamic, shape, place, Rot::IDENTITY, 0.0, restitution);
    }
    sim
}

/// The impulses that a body had from contacts in the last step.
fn pushed(sim: &Sim, body: u32) -> Vector {
    let mut sum = Vector::ZERO;
    for (_, contact) in sim.contacts.iter() {
        let side = contact.bodies.iter().position(|b| *b == body);
        let Some(sign) = side.map(|side| [-1.0, 1.0][side]) else { continue };
        for manifold in core::iter::once(&contact.manifold).chain(sim.contacts.extra_of(contact)) {
            let total: f32 = manifold.points().iter().map(|p| p.total_impulse).sum();
            sum += manifold.normal * (sign * total);
        }
    }
    sum
}

#[test]
fn sums_of_impulses_are_the_momentum_that_bodies_gain() {
    for (restitution, substeps) in [(0.0, 4), (0.0, 1), (0.7, 4), (1.0, 8)] {
        let mut sim = heap(restitution, substeps);
        let mut greatest = 0.0_f32;
        for step in 0..240 {
            let before = sim.bodies.velocities.clone();
            sim.step();
            for id in 1..=24 {
                let mass = sim.colliders[id].def.shape.mass_properties(1.0).mass;
                let gain = (sim.bodies.velocities[id as usize].linear - before[id as usize].linear) * mass;
                let sum = pushed(&sim, id);
                let apart = (gain - sim.gravity * (mass * sim.dt) - sum).length();
                assert!(
                    apart < 1.0e-4 * (1.0 + sum.length()),
                    "e = {restitution}, step {step}: body {id} gained {gain:?}, its contacts gave {sum:?}"
                );
                greatest = greatest.max(sum.length());
            }
        }
        assert!(greatest > 3.0, "no blow above {greatest} N·s");
    }
}

#[test]
fn sums_change_no_bits() {
    for restitution in [0.0, 0.7] {
        let [with, without] = [true, false].map(|sums| {
            let mut sim = heap(restitution, 4);
            sim.contacts.sum_impulses = sums;
            sim.steps(120);
            sim.bodies.velocities.clone()
        });
        assert!(with.iter().zip(&without).all(|(a, b)| a.linear == b.linear));
    }
}
