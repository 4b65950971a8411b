//! Rows of bodies, shared by contact rows that touch different ones.
#![expect(unsafe_code, reason = "rows of disjoint bodies are written through shared views")]

use core::cell::UnsafeCell;

/// Rows shared between batches of one colour.
///
/// A colour holds no dynamic body twice, so no two contact rows of a colour write the same row; what is
/// not dynamic is read by many and written by none. That is what makes the shared writes sound.
pub struct RowView<'a, T> {
    cells: &'a [UnsafeCell<T>],
    first_writable: u32,
}

// SAFETY: threads only touch disjoint rows, or rows that nobody writes (see the type).
unsafe impl<T: Send + Sync> Sync for RowView<'_, T> {}

impl<'a, T> RowView<'a, T> {
    pub(super) fn over(rows: &'a mut [T], first_writable: u32) -> Self {
        // SAFETY: `UnsafeCell<T>` has the layout of `T`, and the rows are borrowed mutably.
        let cells = unsafe { &*(core::ptr::from_mut(rows) as *const [UnsafeCell<T>]) };
        Self { cells, first_writable }
    }

    /// Reads a row.
    #[inline(always)]
    pub(super) fn get(&self, id: u32) -> &T {
        // SAFETY: nobody writes this row meanwhile: a contact row reads its bodies before it writes
        // them, no other row of its colour holds them, and the reference does not outlive the load.
        unsafe { &*self.cells[id as usize].get() }
    }

    /// Changes a row, if it may be written.
    #[inline(always)]
    pub(super) fn put(&self, id: u32, change: impl FnOnce(&mut T)) {
        if id >= self.first_writable {
            // SAFETY: as for `get`; `change` is a store.
            change(unsafe { &mut *self.cells[id as usize].get() });
        }
    }
}
