//! Pairs that the embedder refuses, by layers, when they are found, or when they touch, stop nothing,
//! however fast it is.

use super::dim::sized;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::{BodyKind, ColliderDef, Layers, Velocity};

/// How the pairs of a wall are refused.
#[derive(Clone, Copy, Debug)]
enum Refusal {
    Layers,
    Pairs,
    Contacts,
}

/// The place and velocity along x after some steps of a body shot at walls, some of which may be refused.
fn shot(shape: &Shape, speed: f32, walls: &[(f32, Option<Refusal>)]) -> (f32, f32) {
    let mut sim = Sim::new();
    (sim.dt, sim.substeps, sim.gravity) = (1.0 / 64.0, 6, Vector::ZERO);
    for (x, refusal) in walls {
        let wall = Shape::Cuboid(Cuboid { half: sized(0.1, 4.0, 4.0) });
        let id = sim.add(BodyKind::Static, wall, Vector::X * *x, Rot::IDENTITY);
        match refusal {
            Some(Refusal::Layers) => {
                let layers = Layers { memberships: 2, filters: 2 };
                let def = ColliderDef { layers, ..sim.colliders[id].def.clone() };
                sim.colliders.redefine(id, def, &mut sim.bodies);
            }
            Some(Refusal::Pairs) => sim.unpaired.push(id),
            Some(Refusal::Contacts) => sim.dropped.push(id),
            None => {}
        }
    }
    let id = sim.add(BodyKind::Dynamic, shape.clone(), Vector::ZERO, Rot::IDENTITY);
    sim.bodies.set_velocity(id, Velocity { linear: Vector::X * speed, ..Velocity::default() });
    sim.steps(((6.0 / speed) / sim.dt) as usize + 2);
    (sim.position(id).to_local().x, sim.bodies.velocities[id as usize].linear.x)
}

fn shapes() -> [Shape; 2] {
    let ball = Shape::Ball(Ball { radius: 0.1 });
    [ball, Shape::Cuboid(Cuboid { half: sized(0.1, 0.3, 0.2) })]
}

/// A ball of 0.1 m hung in the air within a platform that let it through, from 3.2 m/s on.
#[test]
fn a_refused_wall_does_not_stop_fast_bodies() {
    for shape in shapes() {
        for refusal in [Refusal::Layers, Refusal::Pairs, Refusal::Contacts] {
            for speed in [1.0, 5.0, 8.7, 20.0, 60.0, 400.0] {
                let free = shot(&shape, speed, &[]);
                let through = shot(&shape, speed, &[(3.0, Some(refusal))]);
                assert!(
                    (through.0 - free.0).abs() < 1e-3 && (through.1 - free.1).abs() < 1e-3,
                    "{refusal:?} at {speed} m/s: {through:?} instead of {free:?}"
                );
            }
        }
    }
}

/// The wall behind a refused one stops what passes that.
#[test]
fn a_wall_within_a_refused_one_stops_fast_bodies() {
    for shape in shapes() {
        for refusal in [Refusal::Layers, Refusal::Pairs, Refusal::Contacts] {
            for speed in [5.0, 8.7, 20.0, 60.0, 400.0] {
                let (x, velocity) = shot(&shape, speed, &[(3.0, Some(refusal)), (3.15, None)]);
                assert!(x < 2.96 && velocity < 0.01, "{refusal:?} at {speed} m/s: {x} m, {velocity} m/s");
            }
        }
    }
}
