//! The condition on which the rows of a colour may be solved by several threads at once, checked in debug builds.

use super::input::RowInput;
use crate::data::BitSet;
use crate::graph::{COLOR_COUNT, ColorGraph, ConstraintKind, OVERFLOW};

/// Buffers of the check, kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    rows: BitSet,
    constraints: [BitSet; ConstraintKind::COUNT],
}

/// Checks that no dynamic body is twice in a colour but the overflow, and no constraint twice in all colours. Body rows
/// from `first_dynamic` on are those that constraints write.
///
/// # Panics
/// If one is.
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
