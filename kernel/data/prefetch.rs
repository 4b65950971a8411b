//! Asking for memory before it is needed.
#![cfg_attr(target_arch = "x86_64", expect(unsafe_code, reason = "the instruction is an intrinsic"))]

/// Brings an element into the cache, if there is one: it will be needed some hundred nanoseconds from now, and no
/// CPU can guess which. Changes nothing but time.
#[inline(always)]
pub(crate) fn prefetch<T>(slice: &[T], index: u32) {
    #[cfg(target_arch = "x86_64")]
    if let Some(element) = slice.get(index as usize) {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let start = core::ptr::from_ref(element).cast::<i8>();
        // It need not begin where a line does: the last byte may be in one line more.
        for byte in (0..size_of::<T>()).step_by(64).chain([size_of::<T>().saturating_sub(1)]) {
            // SAFETY: a prefetch of any address is harmless, and this is within the element.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(byte)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (slice, index);
}
