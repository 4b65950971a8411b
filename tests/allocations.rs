//! The number of allocations per step does not grow with the number of contacts.

use std::sync::{Mutex, PoisonError};

use avian::collision::CollisionDiagnostics;
use bevy_ecs::{hierarchy::ChildOf, name::Name, world::World};
use scenes::{DT, SUBSTEPS, headless_app, pyramid, step};

#[path = "counting.rs"]
mod counting;

/// Allocations are counted for the whole process: one test at a time.
static ALONE: Mutex<()> = Mutex::new(());

/// The median number of allocations of 50 steps after some others, and the final number of contacts.
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
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let pyramid = |base| median_of_steps(|world| drop(pyramid::large(world, base)), 120);
    let ((few, some), (many, more)) = (pyramid(10), pyramid(40));
    assert!(more > 10 * some, "{some} and {more} contacts");
    assert!(many <= few + 8, "{few} allocations with {some} contacts, {many} with {more}");
    // All bodies tumble, and manifolds are recomputed.
    let tumbler = scenes::find("tumbler").expect("a scene of that name");
    let (tumbling, more) = median_of_steps(tumbler.build, 240);
    assert!(more > 10 * some, "{some} and {more} contacts");
    assert!(tumbling <= few + 24, "{few} allocations with {some} contacts, {tumbling} with {more}");
}

/// The number of allocations while a thousand widgets are despawned, one by one or with their parent.
fn taken_by_widgets(world: &mut World) -> [usize; 2] {
    let spawn = |world: &mut World| {
        let window = world.spawn(Name::new("window")).id();
        let row = world.spawn((Name::new("row"), ChildOf(window))).id();
        let widgets = (0..1000).map(|_| world.spawn((Name::new("widget"), ChildOf(row))).id());
        (window, widgets.collect::<Vec<_>>())
    };
    // Lists and tables grow the first time.
    let (window, _) = spawn(world);
    world.despawn(window);
    let (_, widgets) = spawn(world);
    let one_by_one = counting::taken(|| {
        for widget in widgets {
            world.despawn(widget);
        }
    });
    let (window, _) = spawn(world);
    let together = counting::taken(|| assert!(world.despawn(window)));
    [one_by_one.0, together.0]
}

#[test]
fn issue_an_interface_without_physics_allocated_for_every_entity_that_left_its_parent() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let without = taken_by_widgets(&mut World::new());
    let mut app = headless_app(DT, SUBSTEPS);
    pyramid::large(app.world_mut(), 5);
    step(&mut app);
    let with = taken_by_widgets(app.world_mut());
    println!("{without:?} without physics, {with:?} with it");
    assert!(
        (0..2).all(|way| with[way] <= without[way] + 50),
        "{without:?} without physics, {with:?} with it"
    );
}
