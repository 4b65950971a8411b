//! The condition on which the rows of a colour may be solved by several threads at once, checked in debug builds.

use super::input::RowInput;
use crate::data::BitSet;
use crate::graph::{COLOR_COUNT, ColorGraph, OVERFLOW};

/// Checks that no dynamic body is twice in a colour but the overflow, and no contact twice in all colours. Body rows from
/// `first_dynamic` on are those that contacts write.
///
/// # Panics
/// If one is.
pub(super) fn check(input: &RowInput, graph: &ColorGraph, first_dynamic: u32) {
    let (mut contacts, mut rows) = (BitSet::new(), BitSet::new());
    for color in 0..COLOR_COUNT as u8 {
        rows.clear();
        for &contact in graph.contacts(color) {
            assert!(contacts.insert(contact), "contact {contact} is once in the graph");
            if color == OVERFLOW {
                continue;
            }
            for body in input.contacts.bodies_of(contact) {
                let row = input.row_of(body);
                assert!(
                    row < first_dynamic || rows.insert(row),
                    "body {body} is once in colour {color}: the graph is of these contacts and bodies"
                );
            }
        }
    }
}
