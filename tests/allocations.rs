//! What a step takes from the allocator does not grow with its contacts.

use avian::collision::CollisionDiagnostics;
use bevy_ecs::world::World;
use scenes::{DT, SUBSTEPS, headless_app, pyramid, step};

#[path = "counting.rs"]
mod counting;

/// The median of the allocations of 50 steps, after some, and how many contacts there are in the end.
fn median_of_steps(build: impl FnOnce(&mut World), before: u32) -> (usize, u32) {
    let mut app = headless_app(DT, SUBSTEPS);
    build(app.world_mut());
    for _ in 0..before {
        step(&mut app);
    }
    let mut taken: Vec<usize> = (0..50).map(|_| counting::taken(|| step(&mut app)).1).collect();
    taken.sort_unstable();
    let contacts = app.world().resource::<CollisionDiagnostics>().contact_count;
    println!("{contacts} contacts: {taken:?}");
    (taken[25], contacts)
}

#[test]
fn a_step_with_many_contacts_allocates_no_more_than_one_with_few() {
    let pyramid = |base| median_of_steps(|world| drop(pyramid::large(world, base)), 120);
    let ((few, some), (many, more)) = (pyramid(10), pyramid(40));
    assert!(more > 10 * some, "{some} and {more} contacts");
    assert!(many <= few + 8, "{few} allocations with {some} contacts, {many} with {more}");
    // Where everything turns over, and manifolds are computed anew.
    let tumbler = scenes::find("tumbler").expect("a scene of that name");
    let (tumbling, more) = median_of_steps(tumbler.build, 240);
    assert!(more > 10 * some, "{some} and {more} contacts");
    assert!(tumbling <= few + 24, "{few} allocations with {some} contacts, {tumbling} with {more}");
}
