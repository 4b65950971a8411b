//! What a step takes from the allocator does not grow with its contacts.
#![expect(unsafe_code, reason = "an allocator is made of unsafe functions")]

use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

use avian::collision::CollisionDiagnostics;
use bevy_ecs::world::World;
use scenes::{DT, SUBSTEPS, headless_app, pyramid, step};

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

/// The median of the allocations of 50 steps, after some, and how many contacts there are in the end.
fn taken(build: impl FnOnce(&mut World), before: u32) -> (usize, u32) {
    let mut app = headless_app(DT, SUBSTEPS);
    build(app.world_mut());
    for _ in 0..before {
        step(&mut app);
    }
    let mut taken: Vec<usize> = (0..50)
        .map(|_| {
            let before = TAKEN.load(Relaxed);
            step(&mut app);
            TAKEN.load(Relaxed) - before
        })
        .collect();
    taken.sort_unstable();
    let contacts = app.world().resource::<CollisionDiagnostics>().contact_count;
    println!("{contacts} contacts: {taken:?}");
    (taken[25], contacts)
}

#[test]
fn a_step_with_many_contacts_allocates_no_more_than_one_with_few() {
    let pyramid = |base| taken(|world| drop(pyramid::large(world, base)), 120);
    let ((few, some), (many, more)) = (pyramid(10), pyramid(40));
    assert!(more > 10 * some, "{some} and {more} contacts");
    assert!(many <= few + 8, "{few} allocations with {some} contacts, {many} with {more}");
    // Where everything turns over, and manifolds are computed anew.
    let tumbler = scenes::find("tumbler").expect("a scene of that name");
    let (tumbling, more) = taken(tumbler.build, 240);
    assert!(more > 10 * some, "{some} and {more} contacts");
    assert!(tumbling <= few + 24, "{few} allocations with {some} contacts, {tumbling} with {more}");
}
