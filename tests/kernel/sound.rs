//! What safe callers do wrong makes no thread write what another does.

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

/// The colours of a wall of another shape name contacts that share bodies. They are solved by one thread then, so to the same
/// bits each time.
#[test]
fn the_graph_of_another_table_is_solved_by_one_thread() {
    let (mut sim, other) = (wall(12, 12), wall(20, 5));
    assert!(other.contacts.capacity() < sim.contacts.capacity());
    sim.set_workers(4);
    let own = sim.clone();
    assert!(sim.clone().solve_colors_of(&own).0 > 4, "its own colours are shared");
    let (_, first) = sim.clone().solve_colors_of(&other);
    for _ in 0..20 {
        let (shared, rows) = sim.clone().solve_colors_of(&other);
        assert_eq!(shared, 0, "nothing is shared");
        for (row, want) in rows.iter().zip(&first) {
            assert_eq!((row.velocity(), row.delta()), (want.velocity(), want.delta()));
        }
    }
}

/// A body that became dynamic behind the back of the colours is in one many times.
#[test]
fn a_body_retyped_by_hand_is_solved_by_one_thread() {
    use kernel::table::BodyKind;
    let mut sim = wall(12, 6);
    sim.set_workers(4);
    sim.bodies.set_kind(0, BodyKind::Dynamic);
    let own = sim.clone();
    assert_eq!(sim.solve_colors_of(&own).0, 0, "the floor is in many contacts of a colour");
}

/// Limits and spins are applied by threads, each its own: a row named twice has one of either.
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
    // It is a mistake of the caller, which only debug builds tell.
    assert_eq!(twice(&|rows| rows.limit(row, limits)), cfg!(debug_assertions));
    let sides = Vector::from_array(core::array::from_fn(|axis| 1.0 + axis as f32));
    let inv_inertia = inverse_inertia(&Shape::Cuboid(Cuboid { half: sides }).mass_properties(1.0));
    let spins = cfg!(feature = "3d");
    assert_eq!(twice(&|rows| rows.spin(row, inv_inertia, Rot::IDENTITY)), spins && cfg!(debug_assertions));
}
