//! A level that is loaded again: the same bodies get the same bits after any history.

use super::dim::{sized, turned};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Capsule, Cuboid, Shape};
use kernel::table::{BodyKind, BodyPose, Velocity};

/// A pile of boxes, balls and capsules that fall on each other, `columns` wide.
fn pile(sim: &mut Sim, columns: usize, layers: usize) {
    for i in 0..columns * layers {
        let (column, layer) = ((i % columns) as f32, (i / columns) as f32);
        let shape = match i % 3 {
            0 => Shape::Ball(Ball { radius: 0.4 }),
            1 => Shape::Cuboid(Cuboid { half: Vector::ONE * 0.45 }),
            _ => Shape::Capsule(Capsule { a: Vector::X * -0.2, b: Vector::X * 0.2, radius: 0.3 }),
        };
        let at = sized(0.7 * column + 0.2 * (layer % 3.0), 0.6 + layer, 0.1 * (column % 4.0));
        sim.add(BodyKind::Dynamic, shape, at, turned(0.3 * i as f32));
    }
}

fn clear(sim: &mut Sim, kept: u32) {
    let ids: Vec<u32> = sim.bodies.ids.iter().filter(|id| *id >= kept).collect();
    // In no special order, and not last in, first out.
    let (even, odd): (Vec<u32>, Vec<u32>) = ids.iter().partition(|id| *id % 2 == 0);
    even.into_iter().rev().chain(odd).for_each(|id| sim.remove(id));
}

fn state(sim: &Sim) -> Vec<(u32, BodyPose, Velocity)> {
    let of = |id: u32| {
        // Revisions keep counting, so caches do not match.
        let pose = BodyPose { revision: 0, ..sim.bodies.poses[id as usize] };
        (id, pose, sim.bodies.velocities[id as usize])
    };
    sim.bodies.ids.iter().map(of).collect()
}

#[test]
fn issue_a_pile_spawned_after_another_level_came_to_other_bits() {
    let fresh = || {
        let mut sim = Sim::new();
        sim.sleeping = true;
        sim
    };
    let run = |sim: &mut Sim| {
        pile(sim, 8, 8);
        sim.steps(150);
        state(sim)
    };
    for keeps_floor in [false, true] {
        let mut first = fresh();
        first.floor();
        let expected = run(&mut first);
        for (columns, layers, steps) in [(3, 5, 0), (11, 9, 60), (6, 3, 200)] {
            let mut sim = fresh();
            sim.floor();
            pile(&mut sim, columns, layers);
            sim.steps(steps);
            if keeps_floor {
                clear(&mut sim, 1);
            } else {
                clear(&mut sim, 0);
                let half = Vector::ONE * 200.0;
                let block = Shape::Cuboid(Cuboid { half });
                sim.add(BodyKind::Static, block, Vector::Y * -200.0, Rot::IDENTITY);
            }
            assert!(run(&mut sim) == expected, "after {columns} × {layers} bodies and {steps} steps");
        }
    }
}
