//! Rows of bodies, shared by contact rows that touch different ones.
#![expect(unsafe_code, reason = "rows of disjoint bodies are written through shared views")]

use core::cell::UnsafeCell;

/// Rows shared between batches of one colour.
///
/// A colour holds no dynamic body twice, so no two contact rows of a colour write the same row; what is
/// not dynamic is read by many and written by none. That is what makes the shared writes sound. The type cannot
/// know it, so reading and writing are unsafe: [`Solver::build_rows`](super::Solver::build_rows) has the condition.
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

// SAFETY: by the contracts of `get` and `put`, threads write disjoint rows and read only rows that no thread writes.
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
    /// While the reference lives no thread writes this row.
    #[inline(always)]
    pub(super) unsafe fn get(&self, id: u32) -> &T {
        // SAFETY: by the contract.
        unsafe { &*self.cells[id as usize].get() }
    }

    /// Changes a row, if it may be written.
    ///
    /// # Safety
    /// If the row may be written, no other thread reads or writes it meanwhile, and no reference to it lives.
    #[inline(always)]
    pub(super) unsafe fn put(&self, id: u32, change: impl FnOnce(&mut T)) {
        if id >= self.first_writable {
            // SAFETY: by the contract.
            change(unsafe { &mut *self.cells[id as usize].get() });
        }
    }
}
