//! The manifolds of all contacts, for several threads that each change their own.
#![expect(unsafe_code, reason = "several threads change manifolds, each of other contacts")]

use super::record::{Contact, ContactFlags, Manifold};
use super::table::ContactTable;
use crate::data::Parts;

/// The manifolds of all contacts, changed by several threads at once.
pub(crate) struct ManifoldsView<'a> {
    contacts: Parts<'a, Contact>,
    extra: Parts<'a, Vec<Manifold>>,
}

impl ContactTable {
    /// The manifolds, changed by several threads at once.
    pub(crate) fn manifolds_view(&mut self) -> ManifoldsView<'_> {
        ManifoldsView { contacts: Parts::of(&mut self.contacts), extra: Parts::of(&mut self.extra) }
    }
}

impl ManifoldsView<'_> {
    /// Prefetches contacts that are needed soon. Ids without a contact are skipped.
    #[inline(always)]
    pub(crate) fn prefetch(&self, ids: &[u32]) {
        ids.iter().for_each(|id| self.contacts.prefetch(*id));
    }

    /// A contact's manifold by its number, which must exist.
    ///
    /// # Safety
    /// While the manifold is in use no other thread may take one of the same contact.
    #[inline(always)]
    #[expect(clippy::mut_from_ref, reason = "that is what it is for")]
    pub(crate) unsafe fn manifold(&self, id: u32, index: u32) -> &mut Manifold {
        // SAFETY: by the contract the contact and its manifolds in the side pool are this caller's alone.
        unsafe {
            let contact = self.contacts.one(id as usize);
            match index {
                0 => &mut contact.manifold,
                _ => &mut self.extra.one(contact.extra as usize)[index as usize - 1],
            }
        }
    }

    /// The same at the end of a step, and whether its separations are to be set to those of now, as the next update may keep them.
    ///
    /// # Safety
    /// As [`manifold`](Self::manifold).
    #[inline(always)]
    #[expect(clippy::mut_from_ref, reason = "that is what it is for")]
    pub(crate) unsafe fn at_end(&self, id: u32, index: u32) -> (&mut Manifold, bool) {
        // SAFETY: by the contract the contact and its manifolds in the side pool are this caller's alone.
        unsafe {
            let contact = self.contacts.one(id as usize);
            let may_be_calm = contact.may_be_calm();
            contact.flags.set(ContactFlags::CALM, may_be_calm);
            (self.manifold(id, index), may_be_calm)
        }
    }
}
