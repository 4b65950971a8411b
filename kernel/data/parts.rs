//! A slice that several threads change at once, each its own range.
#![expect(unsafe_code, reason = "callers ensure that ranges in use are disjoint")]

use super::prefetch::prefetch;
use core::{cell::UnsafeCell, ops::Range};

/// A slice whose ranges are changed by several threads at once.
pub(crate) struct Parts<'a, T>(&'a [UnsafeCell<T>]);

// SAFETY: by the contracts below no two ranges in use overlap.
unsafe impl<T: Send> Sync for Parts<'_, T> {}

impl<'a, T> Parts<'a, T> {
    pub(crate) fn of(slice: &'a mut [T]) -> Self {
        // SAFETY: `UnsafeCell<T>` has the layout of `T`, and the slice is borrowed mutably.
        Self(unsafe { &*(core::ptr::from_mut(slice) as *const [UnsafeCell<T>]) })
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Prefetches an element, if it exists.
    #[inline(always)]
    pub(crate) fn prefetch(&self, index: u32) {
        prefetch(self.0, index);
    }

    /// The elements of a range.
    ///
    /// # Safety
    /// While the range is in use, no range or element that overlaps it may be taken.
    #[inline(always)]
    pub(crate) unsafe fn take(&self, range: Range<usize>) -> &'a mut [T] {
        let cells = &self.0[range];
        // SAFETY: the layouts are the same, and by the contract this is the only reference to these elements.
        unsafe { core::slice::from_raw_parts_mut(UnsafeCell::raw_get(cells.as_ptr()), cells.len()) }
    }

    /// One element.
    ///
    /// # Safety
    /// While the element is in use, neither it nor a range with it may be taken.
    #[inline(always)]
    pub(crate) unsafe fn one(&self, index: usize) -> &'a mut T {
        // SAFETY: by the contract this is the only reference to the element.
        unsafe { &mut *self.0[index].get() }
    }
}
