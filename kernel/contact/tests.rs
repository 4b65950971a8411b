//! Tests of waking and carried islands, against brute force and by the number of visited bodies, and of a
//! table that does not depend on the number of workers.

use super::*;
use crate::data::BitSet;
use crate::graph::{ColorGraph, IslandId, Islands, SleepScan, VISITS};
use crate::manifold::LocalManifold;
use crate::math::{Pose, Vector, WorldPose};
use crate::shape::{Aabb, Ball, Foreign, Shape};
use crate::table::{BodyKind, BodyTable, ColliderDef, ColliderTable, Fattening};
use crate::thread_pool::ThreadPool;
use proptest::prelude::*;

/// The tables, without a simulation.
#[derive(Default)]
struct World {
    bodies: BodyTable,
    colliders: ColliderTable,
    contacts: ContactTable,
    colors: ColorGraph,
    islands: Islands,
}

impl World {
    /// Bodies with one collider each; body and collider have the same id.
    fn with(kinds: impl IntoIterator<Item = BodyKind>) -> Self {
        Self::of(&Shape::Ball(Ball { radius: 1.0 }), kinds)
    }

    fn of(shape: &Shape, kinds: impl IntoIterator<Item = BodyKind>) -> Self {
        let mut world = Self::default();
        for kind in kinds {
            let body = world.bodies.add(kind, Vector::ZERO, WorldPose::IDENTITY);
            world.contact_manager().enter(body);
            let def = ColliderDef::new(shape.clone(), body);
            assert_eq!(world.colliders.add(def, WorldPose::IDENTITY, &mut world.bodies), body);
        }
        world
    }

    /// `count` dynamic bodies in rows of 32; neighbours touch.
    fn heap(count: u32) -> Self {
        let mut world = Self::with((0..count).map(|_| BodyKind::Dynamic));
        for id in 0..count {
            for next in [id + 1, id + 32].into_iter().filter(|next| *next < count) {
                world.touch(id, next);
            }
        }
        assert_eq!(world.islands.len(), 1);
        world
    }

    fn contact_manager(&mut self) -> ContactManager<'_> {
        ContactManager {
            bodies: &mut self.bodies,
            colliders: &mut self.colliders,
            contacts: &mut self.contacts,
            colors: &mut self.colors,
            islands: Some(&mut self.islands),
        }
    }

    /// Toggles whether two bodies touch.
    fn touch(&mut self, a: u32, b: u32) {
        let id = self.contacts.find(a, b).unwrap_or_else(|| self.contact_manager().create(a, b));
        let flags = &mut self.contacts.get_mut(id).flags;
        flags.set(ContactFlags::TOUCHING, !flags.has(ContactFlags::TOUCHING));
        let mut changed = BitSet::new();
        changed.insert(id);
        self.contact_manager().apply(&changed, |_, _, _| {});
    }

    /// Applies an empty set of changes.
    fn settle(&mut self) {
        self.contact_manager().apply(&BitSet::new(), |_, _, _| {});
    }

    /// Whether a moving kinematic body touches a body of the island, by testing every contact.
    fn is_carried_by_definition(&self, island: IslandId) -> bool {
        let moves = |body: u32| self.bodies[body].kind == BodyKind::Kinematic && self.bodies[body].awake;
        let in_island = |body: u32| self.islands.island_of(body) == Some(island);
        self.contacts.iter().any(|(_, contact)| {
            let [a, b] = contact.bodies;
            contact.is_solved() && (moves(a) && in_island(b) || moves(b) && in_island(a))
        })
    }
}

/// The number of bodies and links of islands that a change of a heap visits.
fn visits(count: u32, change: impl Fn(&mut World)) -> usize {
    let mut world = World::heap(count);
    VISITS.set(0);
    change(&mut world);
    let visits = VISITS.get();
    world.contact_manager().validate();
    visits
}

/// Every contact of the collider lost its colour and its link, and was added again behind all others.
#[test]
fn issue_a_collider_of_another_material_gave_up_the_place_of_its_contacts() {
    let mut world = World::heap(100);
    let places =
        |world: &World| world.contacts.iter().map(|(id, contact)| (id, contact.slot)).collect::<Vec<_>>();
    let before = places(&world);
    for (id, _) in &before {
        // As after the narrow phase.
        world.contacts.get_mut(*id).flags.set(ContactFlags::FROZEN, true);
        world.contacts.get_mut(*id).flags.set(ContactFlags::PLATFORM_A, true);
    }
    VISITS.set(0);
    let change = |world: &mut World, id: u32, change: fn(&mut ColliderDef)| {
        let mut def = world.colliders[id].def.clone();
        change(&mut def);
        let mut manager = world.contact_manager();
        manager.colliders.redefine(id, def, manager.bodies);
        manager.reflag_of_collider(id);
        let visits = VISITS.get();
        manager.validate();
        visits
    };
    let visits = change(&mut world, 40, |def| def.margin = 0.1);
    assert_eq!((visits, places(&world)), (0, before.clone()));
    let frozen = |(_, contact): (u32, &Contact)| contact.flags.has(ContactFlags::FROZEN);
    assert_eq!(world.contacts.iter().filter(|found| !frozen(*found)).count(), 4, "these are computed anew");

    // Contacts of sensors have no colour.
    change(&mut world, 40, |def| def.flags.sensor = true);
    let placed = |world: &World| places(world).iter().filter(|(_, slot)| slot.is_some()).count();
    assert_eq!(placed(&world), before.len() - 4);
    change(&mut world, 40, |def| def.flags.sensor = false);
    assert_eq!(placed(&world), before.len());
}

/// Removing the colliders of ten thousand touching boxes one by one walked over all boxes for each contact.
#[test]
fn removing_all_of_a_heap_looks_at_each_body_a_few_times() {
    for count in [100, 1_000, 10_000] {
        let seen = visits(count, |world| {
            for id in 0..count {
                world.contact_manager().destroy_of_collider(id);
            }
            world.settle();
        });
        assert!(seen <= 2 * count as usize, "{seen} looks at {count} bodies");
    }
}

/// Removing the bodies searched their links in the whole heap.
#[test]
fn despawning_all_of_a_heap_looks_at_each_body_a_few_times() {
    for count in [100, 1_000, 10_000] {
        let seen = visits(count, |world| {
            for id in 0..count {
                world.contact_manager().destroy_of_collider(id);
                world.colliders.remove(id, &mut world.bodies);
                world.contact_manager().leave(id);
            }
            world.settle();
        });
        assert!(seen <= 2 * count as usize, "{seen} looks at {count} bodies");
    }
}

/// Gravity that changes in every frame wakes all bodies.
#[test]
fn waking_every_body_of_a_heap_looks_at_each_once_a_step() {
    for count in [100, 1_000, 10_000] {
        let seen = visits(count, |world| {
            for _ in 0..3 {
                (0..count).for_each(|id| world.contact_manager().wake_body(id));
                world.settle();
            }
        });
        assert_eq!(seen, 3 * count as usize);
    }
}

#[test]
fn a_woken_island_rests_anew_before_it_sleeps() {
    let mut world = World::heap(40);
    let rest = |world: &mut World, time: f32| (0..40).for_each(|id| world.bodies[id].sleep_timer = time);
    let scan = |world: &mut World| {
        let mut scan = SleepScan::new();
        scan.scan(&mut world.islands, 0.5, |body| Some(world.bodies[body].sleep_timer));
        scan.sleepers().len()
    };
    rest(&mut world, 1.0);
    assert_eq!(scan(&mut world), 1);
    world.contact_manager().wake_body(7);
    assert_eq!(scan(&mut world), 0, "nobody has looked at the others yet");
    assert_eq!(world.bodies[7].sleep_timer, 0.0, "the body itself is told at once");
    world.settle();
    assert!((0..40).all(|id| world.bodies[id].sleep_timer == 0.0));
    assert_eq!(scan(&mut world), 0);

    // After that they fall asleep as before.
    rest(&mut world, 0.6);
    world.settle();
    assert!((0..40).all(|id| world.bodies[id].sleep_timer == 0.6));
    assert_eq!(scan(&mut world), 1);

    // From sleep, all timers are reset at once, and no mark remains.
    let island = world.islands.island_of(0).unwrap();
    world.contact_manager().sleep_island(island);
    world.contact_manager().wake_body(3);
    assert!((0..40).all(|id| world.bodies[id].sleep_timer == 0.0 && world.bodies[id].awake));
    assert!(!world.islands.is_woken(island));
    world.contact_manager().validate();
}

/// The mark of a small island also holds for the large island that it merges with, and for both parts after a
/// split.
#[test]
fn a_woken_body_rests_anew_in_whatever_island_it_comes_to() {
    let mut world = World::with([BodyKind::Dynamic; 6]);
    let mark = |world: &mut World, body: u32| {
        (0..6).for_each(|id| world.bodies[id].sleep_timer = 1.0);
        world.islands.mark_woken(world.islands.island_of(body).unwrap());
    };
    [(0, 1), (1, 2), (2, 3), (4, 5)].into_iter().for_each(|(a, b)| world.touch(a, b));
    mark(&mut world, 4);
    world.touch(3, 4);
    assert!([4, 5].into_iter().all(|id| world.bodies[id].sleep_timer == 0.0));
    world.contact_manager().validate();

    world.touch(3, 4);
    mark(&mut world, 0);
    let island = world.islands.island_of(0).unwrap();
    assert_eq!(world.islands.split(island).len(), 1);
    world.settle();
    assert!((0..6).all(|id| world.bodies[id].sleep_timer == 0.0));
    world.contact_manager().validate();
}

/// A source of varying numbers of manifolds, different in each round.
struct Rounds(u32);

impl ManifoldSource for Rounds {
    fn ball_manifolds(&self, _: u32, _: Vector, _: f32, _: f32, _: &mut Vec<LocalManifold>) {
        unreachable!("nothing is swept");
    }

    fn manifolds(&self, [a, b]: [u32; 2], _: &Pose, _: f32, out: &mut Vec<LocalManifold>) {
        // Some take long, so that workers take contacts in another order.
        if a % 97 == 3 {
            std::thread::sleep(std::time::Duration::from_micros(300));
        }
        for i in 0..(a * 7 + b * 3 + self.0 * 5) % 5 {
            let mut manifold = LocalManifold { normal: Vector::Y, ..LocalManifold::default() };
            manifold.push(Vector::X * (i as f32 + 0.1 * self.0 as f32), -0.01, i);
            out.push(manifold);
        }
    }
}

/// The place of further manifolds in the side pool depended on the worker that found them.
#[test]
fn the_table_is_the_same_to_the_byte_whatever_pool_updated_it() {
    let aabb = Aabb { min: -Vector::ONE, max: Vector::ONE };
    let after = |workers: usize| {
        let count = 1_200;
        let mut world = World::of(&Shape::Foreign(Foreign { aabb }), (0..count).map(|_| BodyKind::Dynamic));
        for id in 0..count {
            world.colliders.refresh(id, &world.bodies, Fattening { margin: 0.1, dt: 0.01 });
            if id > 0 {
                world.contact_manager().create(id - 1, id);
            }
        }
        let pool = ThreadPool::new(workers);
        let mut buffers = Vec::new();
        for round in 0..4 {
            pool.wake();
            let source = Rounds(round);
            let input = NarrowPhaseInput::new(&world.bodies, &world.colliders, &source, 0.01);
            let mut changed = BitSet::new();
            world.contacts.update(&input, &pool, &mut buffers, &mut changed);
            world.contact_manager().apply(&changed, |_, _, _| {});
            world.contact_manager().validate();
            // Freed places are used again.
            world.contacts.recycle_ids();
            for id in (round..count).step_by(50).filter(|id| *id > 0) {
                let contact = world.contacts.find(id - 1, id).unwrap();
                world.contact_manager().destroy(contact);
                world.contact_manager().create(id - 1, id);
            }
        }
        let more = world.contacts.iter().filter(|(_, contact)| contact.extra_count > 0).count();
        assert!(more > 500, "{more} contacts have more than one manifold");
        format!("{:?}", world.contacts)
    };
    let alone = after(1);
    for workers in [2, 4, 8] {
        assert!(after(workers) == alone, "other bytes with {workers} workers");
    }
}

/// Sensors on static bodies are updated once after they were moved. Only shapes that overlap touch them.
#[test]
fn a_visited_sensor_at_rest_is_updated_once() {
    for (distance, touches) in [(1.9, true), (2.01, false)] {
        let mut world = World::with([BodyKind::Static; 2]);
        let mut def = world.colliders[1].def.clone();
        def.flags.sensor = true;
        def.local = Pose::new(Vector::X * distance, Default::default());
        world.colliders.redefine(1, def, &mut world.bodies);
        for id in 0..2 {
            world.colliders.refresh(id, &world.bodies, Fattening { margin: 0.1, dt: 0.01 });
        }
        let id = world.contact_manager().create(0, 1);
        let pool = ThreadPool::new(1);
        let update = |world: &mut World| {
            let input = NarrowPhaseInput::new(&world.bodies, &world.colliders, &(), 0.01);
            let mut changed = BitSet::new();
            world.contacts.update(&input, &pool, &mut Vec::new(), &mut changed);
            let mut began = 0;
            world
                .contact_manager()
                .apply(&changed, |_, _, status| began += usize::from(status == Status::Began));
            world.contact_manager().validate();
            began
        };
        assert_eq!(update(&mut world), 0, "nothing is awake");
        world.contact_manager().visit_of_collider(1);
        assert!(world.contacts.is_active(id));
        assert_eq!(update(&mut world), usize::from(touches), "{distance}");
        assert!(!world.contacts.is_active(id), "visited once");
        assert_eq!(world.contacts.get(id).flags.has(ContactFlags::TOUCHING), touches);
    }
}

const KINDS: [BodyKind; 3] = [BodyKind::Static, BodyKind::Kinematic, BodyKind::Dynamic];

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// Random contacts, lifts that start and stop, changes of kind, splits, sleep and removal.
    #[test]
    fn islands_know_what_carries_them(
        kinds in prop::collection::vec(prop::sample::select(vec![KINDS[0], KINDS[1], KINDS[2], KINDS[2]]), 4..30),
        operations in prop::collection::vec((0u8..20, any::<u32>(), any::<u32>()), 300),
    ) {
        let count = kinds.len() as u32;
        let mut world = World::with(kinds);
        for (kind, x, y) in operations {
            let (a, b) = (x % count, y % count);
            let island = world.islands.island_of(a);
            match (kind, island) {
                (0..10, _) if a != b => world.touch(a, b),
                (10..13, _) => world.contact_manager().set_kinematic_awake(a, y % 2 == 0),
                (13, _) => world.contact_manager().retype(a, KINDS[b as usize % 3]),
                (14, Some(island)) => _ = world.islands.split(island),
                (15, Some(island)) => world.contact_manager().sleep_island(island),
                (16, _) => world.contact_manager().wake_body(a),
                (17, _) => world.contact_manager().destroy_of_collider(a),
                (18, Some(island)) => world.islands.mark_woken(island),
                (19, _) => world.settle(),
                _ => {}
            }
            world.contact_manager().validate();
            for island in world.islands.islands().collect::<Vec<_>>() {
                let expected = world.is_carried_by_definition(island);
                prop_assert_eq!(world.contact_manager().is_carried(island), expected);
            }
        }
    }
}
