//! Mistakes of callers never make two threads write the same data: they panic in debug builds, or
//! have no effect.

use super::dim::inverse_inertia;
use super::sim::Sim;
use kernel::{
    math::{AxisLocks, Rot, Vector},
    shape::{Cuboid, Shape},
    solver::Limits,
};
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::kernel;

/// A wall of boxes that touch each other.
fn wall(columns: u32, rows: u32) -> Sim {
    let mut sim = Sim::new();
    sim.floor();
    for row in 0..rows {
        for column in 0..columns {
            let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
            let place = Vector::X * (column as f32 + shift) + Vector::Y * (0.5 + row as f32);
            sim.cuboid(Vector::ONE * 0.5, place);
        }
    }
    sim.steps(3);
    sim
}

/// The colours of another simulation's wall have contacts that share bodies. Release builds trust the caller.
#[test]
#[cfg(debug_assertions)]
fn the_graph_of_another_table_is_refused() {
    let (mut sim, other) = (wall(12, 12), wall(20, 5));
    assert!(other.contacts.capacity() < sim.contacts.capacity());
    sim.set_workers(4);
    let own = sim.clone();
    assert!(sim.clone().solve_colors_of(&own) > 4, "its own colours are shared");
    assert!(catch_unwind(AssertUnwindSafe(|| sim.solve_colors_of(&other))).is_err());
}

/// The graph was not told that a body became dynamic, so a colour has it several times.
#[test]
#[cfg(debug_assertions)]
fn a_body_retyped_by_hand_is_refused() {
    use kernel::table::BodyKind;
    let mut sim = wall(12, 6);
    sim.set_workers(4);
    sim.bodies.set_kind(0, BodyKind::Dynamic);
    let own = sim.clone();
    assert!(catch_unwind(AssertUnwindSafe(|| sim.solve_colors_of(&own))).is_err());
}

/// Limits and spins are applied in parallel by row: a row that is named twice gets one of each.
#[test]
fn a_row_named_twice_is_limited_and_spun_once() {
    let mut sim = wall(2, 1);
    let rows = sim.rows();
    let limits = Limits { locks: AxisLocks(0b100_000), ..Limits::NONE };
    let mut twice = |name: &dyn Fn(&mut kernel::solver::BodyRows)| {
        name(rows);
        catch_unwind(AssertUnwindSafe(|| name(rows))).is_err()
    };
    let row = 1;
    // A mistake of the caller, which only debug builds report.
    assert_eq!(twice(&|rows| rows.limit(row, limits)), cfg!(debug_assertions));
    let sides = Vector::from_array(core::array::from_fn(|axis| 1.0 + axis as f32));
    let inv_inertia = inverse_inertia(&Shape::Cuboid(Cuboid { half: sides }).mass_properties(1.0));
    let spins = super::dim::upright().is_some();
    assert_eq!(twice(&|rows| rows.spin(row, inv_inertia, Rot::IDENTITY)), spins && cfg!(debug_assertions));
}
