//! Body rows, shared by constraint rows that write different bodies.
#![expect(unsafe_code, reason = "rows of disjoint bodies are written through shared views")]

use crate::math::{Ids, Lane, Quad};
use core::cell::UnsafeCell;

/// Body rows, shared by the batches of one colour.
///
/// Constraints of a colour share no dynamic body, so no two of them write the same row. Kinematic and
/// static rows are only read. This makes the shared writes sound. The type cannot check it, so reading and
/// writing are unsafe: [`Solver::build_rows`](super::Solver::build_rows) states the condition.
pub(super) struct RowView<'a, T> {
    cells: &'a [UnsafeCell<T>],
    first_writable: u32,
}

impl<T> Clone for RowView<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for RowView<'_, T> {}

// SAFETY: by the contracts of `get` and `put`, threads write disjoint rows and read only rows that no
// thread writes.
unsafe impl<T: Send + Sync> Sync for RowView<'_, T> {}

impl<'a, T> RowView<'a, T> {
    pub(super) fn over(rows: &'a mut [T], first_writable: u32) -> Self {
        // SAFETY: `UnsafeCell<T>` has the layout of `T`, and the rows are borrowed mutably.
        let cells = unsafe { &*(core::ptr::from_mut(rows) as *const [UnsafeCell<T>]) };
        Self { cells, first_writable }
    }

    /// Reads a row.
    ///
    /// # Safety
    /// No thread writes this row while the reference is in use.
    #[inline(always)]
    pub(super) unsafe fn get(&self, id: u32) -> &T {
        // SAFETY: by the contract.
        unsafe { &*self.cells[id as usize].get() }
    }

    /// Changes a row if it is writable.
    ///
    /// # Safety
    /// If the row is writable, no other thread reads or writes it until the call returns, and no reference
    /// to it is in use.
    #[inline(always)]
    pub(super) unsafe fn put(&self, id: u32, change: impl FnOnce(&mut T)) {
        if id >= self.first_writable {
            // SAFETY: by the contract.
            change(unsafe { &mut *self.cells[id as usize].get() });
        }
    }

    /// Whether the rows of all lanes are writable.
    #[inline(always)]
    pub(super) fn are_writable(&self, ids: &impl Ids) -> bool {
        ids.lanes().iter().fold(true, |all, id| all & (*id >= self.first_writable))
    }

    /// Changes the rows of all lanes, each by its quad of `values`. `are_writable` is the result of
    /// [`are_writable`](Self::are_writable) for these lanes. If it is false, only the writable rows change.
    ///
    /// # Safety
    /// As [`put`](Self::put).
    #[inline(always)]
    pub(super) unsafe fn scatter<N: Lane>(
        &self,
        values: [N; 4],
        ids: &N::Ids,
        are_writable: bool,
        set: impl Fn(&mut T, Quad),
    ) {
        if are_writable {
            // SAFETY: by the contract.
            N::scatter(values, ids, |id, quad| unsafe { set(&mut *self.cells[id as usize].get(), quad) });
        } else {
            // SAFETY: by the contract.
            N::scatter(values, ids, |id, quad| unsafe { self.put(id, |row| set(row, quad)) });
        }
    }
}
