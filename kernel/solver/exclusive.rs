//! The condition on which the rows of a colour may be solved by several threads at once, checked in debug builds.

use super::input::RowInput;
use crate::data::BitSet;
use crate::graph::{COLOR_COUNT, ColorGraph, ConstraintKind, OVERFLOW};

/// Checks that no dynamic body is twice in a colour but the overflow, and no constraint twice in all colours. Body rows
/// from `first_dynamic` on are those that constraints write.
///
/// # Panics
/// If one is.
pub(super) fn check(input: &RowInput, graph: &ColorGraph, first_dynamic: u32) {
    let mut rows = BitSet::new();
    let mut seen: [BitSet; ConstraintKind::COUNT] = Default::default();
    // Allocated at once: that steps do not allocate with their contacts is tested in debug builds.
    rows.grow(input.bodies.rows.len() + 1);
    seen.iter_mut().for_each(|seen| seen.grow(input.contacts.capacity()));
    for color in 0..COLOR_COUNT as u8 {
        rows.clear();
        for kind in ConstraintKind::ALL {
            for &id in graph.constraints(kind, color) {
                assert!(seen[kind as usize].insert(id), "{kind:?} {id} is once in the graph");
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
