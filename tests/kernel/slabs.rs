//! Slabs that slide over many tiles.

use super::dim::{sized, upright};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{DIM, Rot, Vector};
use kernel::shape::{Cuboid, Shape};
use kernel::table::{BodyKind, Velocity};
use std::time::{Duration, Instant};

/// A slab on about as many tiles of a metre that moves at a speed, in 3D askew to their edges.
fn on_tiles(tiles: usize, speed: f32) -> Sim {
    let mut sim = Sim::new();
    (sim.checked, sim.sleeping) = (false, false);
    let side = if DIM == 2 { tiles } else { tiles.isqrt() };
    let around = 12;
    let rows = if DIM == 2 { 1 } else { side + 2 * around };
    let block = |half: Vector| Shape::Cuboid(Cuboid { half });
    for k in 0..(side + 2 * around) * rows {
        let place = |k: usize| k as f32 - 0.5 * (side - 1) as f32 - around as f32;
        let at = sized(place(k / rows), -0.5, if DIM == 2 { 0.0 } else { place(k % rows) });
        sim.add_with(BodyKind::Static, block(Vector::ONE * 0.5), at, Rot::IDENTITY, 0.0, 0.0);
    }
    let half = 0.5 * side as f32;
    let turn = upright().map_or(Rot::IDENTITY, |up| Rot::IDENTITY.turned_by(up * 0.3));
    let slab = block(sized(half, 0.5, half));
    let id = sim.add_with(BodyKind::Dynamic, slab, sized(0.23, 0.5, 0.29), turn, 0.0, 0.0);
    sim.bodies.set_velocity(id, Velocity { linear: Vector::X * speed, ..Velocity::default() });
    sim
}

/// A slab that slides meets the sides of tiles ahead, and leaves tiles behind, beside all that it lies on.
#[test]
fn a_slab_that_slides_over_many_tiles_takes_a_few_times_as_long_as_one_at_rest() {
    let mut slabs = [0.0, 10.0].map(|speed| on_tiles(6400, speed));
    slabs.iter_mut().for_each(|sim| sim.steps(12));
    let mut least = [Duration::MAX; 2];
    for _ in 0..6 {
        // A metre.
        for (sim, least) in slabs.iter_mut().zip(&mut least) {
            let start = Instant::now();
            sim.steps(6);
            *least = start.elapsed().min(*least);
        }
    }
    let [rest, sliding] = least.map(|time| time.as_secs_f64());
    println!("{DIM}D: {rest} {sliding}");
    // In 2D it was 12 times where each manifold was compared with each other one.
    assert!(sliding < 6.0 * rest, "it takes {} times as long", sliding / rest);
}
