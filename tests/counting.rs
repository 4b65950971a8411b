//! The system's allocator, which counts: for a test that is alone in its process, as others would be counted too.
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
    // A thread that ends has none any more.
    let _ = TAKEN_HERE.try_with(|taken| taken.set(taken.get() + 1));
}

// SAFETY: every call is passed on to the system's allocator as it came.
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

/// How often something is allocated meanwhile: on this thread, and on all.
pub fn taken(run: impl FnOnce()) -> (usize, usize) {
    let now = || (TAKEN_HERE.get(), TAKEN.load(Relaxed));
    let before = now();
    run();
    let after = now();
    (after.0 - before.0, after.1 - before.1)
}
