//! The condition for solving the rows of a colour in parallel, checked in debug builds.

use super::input::RowInput;
use crate::data::BitSet;
use crate::graph::{COLOR_COUNT, ColorGraph, ConstraintKind, OVERFLOW};

/// Buffers of the check, kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    rows: BitSet,
    constraints: [BitSet; ConstraintKind::COUNT],
}

/// Checks that no dynamic body occurs twice in a colour other than the overflow, and no constraint twice in
/// the graph. `first_dynamic` is the first row that constraints write.
///
/// # Panics
/// If a body or constraint occurs twice.
pub(super) fn check(seen: &mut Seen, input: &RowInput, graph: &ColorGraph, first_dynamic: u32) {
    let Seen { rows, constraints } = seen;
    constraints.iter_mut().for_each(BitSet::clear);
    for color in 0..COLOR_COUNT as u8 {
        rows.clear();
        for kind in ConstraintKind::ALL {
            for &id in graph.constraints(kind, color) {
                assert!(constraints[kind as usize].insert(id), "{kind:?} {id} is once in the graph");
                for body in input.bodies_of(kind, id) {
                    let row = input.row_of(body);
                    assert!(
                        row < first_dynamic || color == OVERFLOW || rows.insert(row),
                        "body {body} is once in colour {color}: the graph is of these constraints and bodies"
                    );
                }
            }
        }
    }
}
