//! The system's allocator with a counter, for a test that is alone in its process.
#![expect(unsafe_code, reason = "an allocator is made of unsafe functions")]

use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

struct Counting;

static TAKEN: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    static TAKEN_HERE: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    TAKEN.fetch_add(1, Relaxed);
    // The counter of a thread that ends is gone.
    let _ = TAKEN_HERE.try_with(|taken| taken.set(taken.get() + 1));
}

// SAFETY: every call is forwarded to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract, which is the same.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as above.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The number of allocations of a closure: on this thread, and on all.
pub fn taken(run: impl FnOnce()) -> (usize, usize) {
    let now = || (TAKEN_HERE.get(), TAKEN.load(Relaxed));
    let before = now();
    run();
    let after = now();
    (after.0 - before.0, after.1 - before.1)
}
