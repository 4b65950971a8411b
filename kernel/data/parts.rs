//! A slice that several threads change at once, each its own part.
#![expect(unsafe_code, reason = "who takes parts answers for their being disjoint")]

use super::prefetch::prefetch;
use core::{cell::UnsafeCell, ops::Range};

/// A slice whose parts are changed at once.
pub(crate) struct Parts<'a, T>(&'a [UnsafeCell<T>]);

// SAFETY: who takes parts takes care that no two overlap.
unsafe impl<T: Send> Sync for Parts<'_, T> {}

impl<'a, T> Parts<'a, T> {
    pub(crate) fn of(slice: &'a mut [T]) -> Self {
        // SAFETY: `UnsafeCell<T>` has the layout of `T`, and the slice is borrowed mutably.
        Self(unsafe { &*(core::ptr::from_mut(slice) as *const [UnsafeCell<T>]) })
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Has an element brought near, if there is one.
    #[inline(always)]
    pub(crate) fn prefetch(&self, index: u32) {
        prefetch(self.0, index);
    }

    /// # Safety
    /// While the part is in use nobody may take one that overlaps it.
    #[inline(always)]
    pub(crate) unsafe fn take(&self, range: Range<usize>) -> &'a mut [T] {
        let cells = &self.0[range];
        // SAFETY: the layouts are the same, and by the contract nobody else has these.
        unsafe { core::slice::from_raw_parts_mut(UnsafeCell::raw_get(cells.as_ptr()), cells.len()) }
    }

    /// # Safety
    /// While the element is in use nobody may take it, nor a part that it is in.
    #[inline(always)]
    pub(crate) unsafe fn one(&self, index: usize) -> &'a mut T {
        // SAFETY: by the contract nobody else has it.
        unsafe { &mut *self.0[index].get() }
    }
}
