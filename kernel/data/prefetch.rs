//! Prefetching memory.
#![cfg_attr(target_arch = "x86_64", expect(unsafe_code, reason = "the instruction is an intrinsic"))]

/// Prefetches an element into the cache, if it exists. It is for elements that are needed in some hundred
/// nanoseconds and that the CPU cannot predict. Results do not depend on it.
#[inline(always)]
pub(crate) fn prefetch<T>(slice: &[T], index: u32) {
    #[cfg(target_arch = "x86_64")]
    if let Some(element) = slice.get(index as usize) {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let start = core::ptr::from_ref(element).cast::<i8>();
        for line in 0..size_of::<T>().div_ceil(64) {
            // SAFETY: a prefetch of any address is harmless, and this address is within the element.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(64 * line)) };
        }
        // The element may begin within a line, so its last byte may be in one more line.
        if !align_of::<T>().is_multiple_of(64) {
            // SAFETY: as above.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.add(size_of::<T>().saturating_sub(1))) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (slice, index);
}
