//! Inputs for building rows.

use crate::contact::ContactTable;
use crate::graph::ConstraintKind;
use crate::table::{BodyTable, ColliderTable, NONE};

/// Inputs for building rows.
pub struct RowInput<'a> {
    /// The contacts, with their manifolds.
    pub contacts: &'a ContactTable,
    /// The bodies, with their rows.
    pub bodies: &'a BodyTable,
    /// The colliders, whose facets may have materials.
    pub colliders: &'a ColliderTable,
}

impl RowInput<'_> {
    /// The bodies of a constraint.
    pub(super) fn bodies_of(&self, kind: ConstraintKind, id: u32) -> [u32; 2] {
        match kind {
            ConstraintKind::Contact => self.contacts.bodies_of(id),
            _ => self.bodies.constraints(kind).get(id).bodies,
        }
    }

    /// Row of a body in this step; the dummy's row 0 for [`NONE`].
    #[inline(always)]
    pub(super) fn row_of(&self, body: u32) -> u32 {
        if body == NONE { 0 } else { self.bodies.rows[body as usize] }
    }
}

/// The source of one lane of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Item {
    /// The id of the constraint.
    pub(super) id: u32,
    /// Number of the row within its constraint; for contacts, the number of the manifold.
    pub(super) index: u32,
}
