//! Whether the contacts of a colour may be solved by several threads at once.

use super::input::RowInput;
use crate::data::BitSet;
use crate::graph::{COLOR_COUNT, ColorGraph, OVERFLOW};
use crate::team::Team;

/// What the colours promise, looked at before threads rely on it: that a dynamic body is once in a colour, and a contact
/// once in all of them.
///
/// Decision: the graph is kept by [`Link`](crate::contact::Link), but nothing ties it to the contacts and bodies that rows are
/// built from, and bodies can be changed by hand. With the graph of other contacts, two threads would write one body.
/// An `unsafe` function would only hand the question on. To look takes a few nanoseconds a contact, by the whole team, and
/// nothing in a team of one. Where the promise is broken the caller solves all rows alone.
#[derive(Clone, Debug, Default)]
pub(super) struct Exclusive {
    colors: Vec<Found>,
    /// All contacts.
    contacts: BitSet,
    holds: bool,
    first_dynamic: u32,
}

/// What a colour has.
#[derive(Clone, Debug, Default)]
struct Found {
    contacts: BitSet,
    rows: BitSet,
    is_twice: bool,
}

impl Exclusive {
    /// Looks at all colours. Body rows from `first_dynamic` on are those that contacts write.
    pub(super) fn look(&mut self, input: &RowInput, graph: &ColorGraph, first_dynamic: u32, team: &Team) {
        self.first_dynamic = first_dynamic;
        self.holds = team.members() > 1;
        if !self.holds {
            return;
        }
        self.colors.resize_with(COLOR_COUNT, Found::default);
        team.each(self.colors.iter_mut().zip(0..), |(found, color)| {
            found.look(color, input, graph.contacts(color), first_dynamic);
        });
        self.contacts.clear();
        for found in &self.colors {
            self.holds &= !found.is_twice && self.contacts.is_disjoint(&found.contacts);
            self.contacts.union_with(&found.contacts);
        }
    }

    /// Whether there was a team when the rows were built, and the promise held: no two contacts of a colour but the overflow write one body row, and
    /// no contact is there twice.
    pub(super) fn holds(&self) -> bool {
        self.holds
    }

    /// The first body row that contacts may write, whatever has become of the bodies since.
    pub(super) fn first_dynamic(&self) -> u32 {
        self.first_dynamic
    }
}

impl Found {
    fn look(&mut self, color: u8, input: &RowInput, contacts: &[u32], first_dynamic: u32) {
        self.contacts.clear();
        self.rows.clear();
        let mut is_once = true;
        for &contact in contacts {
            is_once &= self.contacts.insert(contact);
            if color != OVERFLOW {
                let rows = input.contacts.bodies_of(contact).map(|body| input.row_of(body));
                for row in rows.into_iter().filter(|row| *row >= first_dynamic) {
                    is_once &= self.rows.insert(row);
                }
            }
        }
        self.is_twice = !is_once;
    }
}
