//! Restitution of what falls on a floor: the rebound is e² of the height.

use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Scalar, Vector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::BodyKind;

/// The height to which a shape rebounds that falls ten metres onto a floor.
fn rebound(shape: Shape, e: f32, dt: f32, substeps: u32) -> Scalar {
    let mut sim = Sim::new();
    (sim.dt, sim.substeps) = (dt, substeps);
    let floor = Shape::Cuboid(Cuboid { half: Vector::ONE * 200.0 });
    sim.add_with(BodyKind::Static, floor, Vector::Y * -200.0, Rot::IDENTITY, 0.5, e);
    let id = sim.add_with(BodyKind::Dynamic, shape, Vector::Y * 10.5, Rot::IDENTITY, 0.5, e);
    let (mut bounced, mut highest): (bool, Scalar) = (false, 0.0);
    for _ in 0..(6.0 / dt) as usize {
        sim.step();
        let v = sim.bodies.velocities[id as usize].linear.y;
        bounced |= v > 0.0;
        if bounced {
            highest = highest.max(sim.position(id).y - 0.5);
            if v < 0.0 {
                break;
            }
        }
    }
    highest
}

/// At e = 0.1 a box rebounded 3.5 % too low: the sweeps over its points left 0.3 % of the impact.
#[test]
fn balls_and_flat_boxes_rebound_to_e_squared_of_the_height() {
    let shapes = [Shape::Ball(Ball { radius: 0.5 }), Shape::Cuboid(Cuboid { half: Vector::ONE * 0.5 })];
    for (dt, substeps) in [(1.0 / 64.0, 6), (1.0 / 60.0, 4), (1.0 / 120.0, 2), (1.0 / 30.0, 8)] {
        for shape in &shapes {
            for e in [0.1f32, 0.2, 0.3, 0.5, 0.7, 0.9, 0.95] {
                let want = Scalar::from(10.0 * e * e);
                let got = rebound(shape.clone(), e, dt, substeps);
                let error = (got / want - 1.0).abs();
                assert!(error < 0.01, "{dt} s in {substeps}, e = {e}: {got} m, not {want}: {shape:?}");
            }
        }
    }
}
