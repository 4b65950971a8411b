//! What rows are made from.

use crate::contact::ContactTable;
use crate::table::{BodyTable, NONE};

/// What rows are made from.
pub struct RowInput<'a> {
    /// The contacts, with their manifolds.
    pub contacts: &'a ContactTable,
    /// Which row each body has.
    pub bodies: &'a BodyTable,
}

impl RowInput<'_> {
    /// A body's row in this step; the dummy for none.
    #[inline(always)]
    pub(super) fn row_of(&self, body: u32) -> u32 {
        if body == NONE { 0 } else { self.bodies.rows[body as usize] }
    }
}
