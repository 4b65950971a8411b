//! Manifolds and contact updates take nothing from the allocator.
#![expect(unsafe_code, reason = "an allocator is made of unsafe functions")]

use crate::kernel;
use kernel::manifold::{FeatureCache, LocalManifold, collide};
use measure::{Contacts, KINDS, MIXED, PREDICTION, pairs};
use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

#[path = "measure/mod.rs"]
mod measure;

/// The system's allocator, which counts.
struct Counting;

static TAKEN: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is passed on to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        TAKEN.fetch_add(1, Relaxed);
        // SAFETY: the caller keeps the contract, which is the same.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        TAKEN.fetch_add(1, Relaxed);
        // SAFETY: as above.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// How often something is allocated meanwhile.
fn taken(run: impl FnOnce()) -> usize {
    let before = TAKEN.load(Relaxed);
    run();
    TAKEN.load(Relaxed) - before
}

/// One test, as others at the same time would be counted too.
#[test]
fn manifolds_and_contacts_allocate_nothing() {
    for (name, a, b) in KINDS {
        let pairs = pairs(64, &MIXED, &mut |dice| [a(dice), b(dice)]);
        let manifolds = taken(|| {
            for pair in &pairs {
                for (pose, mut cache) in pair.poses.iter().zip([FeatureCache::NONE, pair.cache]) {
                    let [a, b] = &pair.shapes;
                    collide(a, b, pose, PREDICTION, &mut cache, &mut LocalManifold::default());
                    collide(b, a, &pose.inverse(), PREDICTION, &mut cache, &mut LocalManifold::default());
                }
            }
        });
        assert_eq!(manifolds, 0, "manifolds of {name}");
        // What is kept between steps is made in the first.
        let mut all = Contacts::of(&pairs);
        all.update(false);
        all.update(true);
        for recycle in [true, false] {
            all.nudge();
            assert_eq!(taken(|| all.update(recycle)), 0, "contacts of {name}, recycled: {recycle}");
        }
    }
}
