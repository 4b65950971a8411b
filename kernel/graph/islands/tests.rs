//! Islands against brute-force connected components, through long random histories.

use super::*;
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet, btree_map::Entry};

/// The islands with the caller's records: bodies with their sleep state, and links.
#[derive(Clone, Default)]
struct World {
    islands: Islands,
    asleep: BTreeMap<u32, bool>,
    links: BTreeMap<u32, (u32, u32)>,
}

impl World {
    fn with_bodies(bodies: u32) -> Self {
        let mut world = Self::default();
        (0..bodies).for_each(|body| world.add(body));
        world
    }

    fn add(&mut self, body: u32) {
        self.islands.add_body(body);
        self.asleep.insert(body, false);
    }

    fn remove(&mut self, body: u32) {
        let keys: Vec<u32> =
            self.links.iter().filter(|(_, (a, b))| *a == body || *b == body).map(|(key, _)| *key).collect();
        keys.into_iter().for_each(|key| self.unlink(key));
        self.islands.remove_body(body);
        self.asleep.remove(&body);
        assert_eq!(self.islands.island_of(body), None);
    }

    fn island(&self, body: u32) -> IslandId {
        self.islands.island_of(body).unwrap()
    }

    fn set_asleep(&mut self, island: IslandId, asleep: bool) {
        for body in self.islands.bodies(island) {
            self.asleep.insert(*body, asleep);
        }
        self.islands.set_asleep(island, asleep);
    }

    fn link(&mut self, key: u32, a: u32, b: u32) {
        if self.asleep[&a] != self.asleep[&b] {
            [a, b].into_iter().for_each(|body| self.set_asleep(self.island(body), false));
        }
        let island = self.islands.link(LinkId(key), a, b);
        assert!(
            island.is_some() && island == self.islands.island_of(a) && island == self.islands.island_of(b)
        );
        self.links.insert(key, (a, b));
    }

    fn unlink(&mut self, key: u32) {
        let (a, _) = self.links.remove(&key).unwrap();
        let (island, removed) = (self.island(a), self.islands.removed(self.island(a)));
        assert!(self.islands.unlink(LinkId(key)));
        assert_eq!(self.islands.removed(island), removed + 1);
    }

    /// The lowest body in the connected component of each body, by a search through all links.
    fn components(&self) -> BTreeMap<u32, u32> {
        let mut neighbours: BTreeMap<u32, Vec<u32>> =
            self.asleep.keys().map(|body| (*body, vec![])).collect();
        for (a, b) in self.links.values() {
            neighbours.get_mut(a).unwrap().push(*b);
            neighbours.get_mut(b).unwrap().push(*a);
        }
        let mut lowest = BTreeMap::new();
        for &start in self.asleep.keys() {
            let mut stack = vec![start];
            while let Some(body) = stack.pop() {
                if let Entry::Vacant(unseen) = lowest.entry(body) {
                    unseen.insert(start);
                    stack.extend(&neighbours[&body]);
                }
            }
        }
        lowest
    }

    fn split_all(&mut self) {
        for island in self.islands.islands().collect::<Vec<_>>() {
            let (size, asleep) = (self.islands.bodies(island).len(), self.islands.is_asleep(island));
            let created = self.islands.split(island).to_vec();
            let lowest: Vec<u32> = created
                .iter()
                .map(|id| self.islands.bodies(*id).iter().copied().min().expect("a new island has bodies"))
                .collect();
            assert!(lowest.is_sorted(), "new islands come by ascending lowest body");
            for part in &created {
                let part_size = self.islands.bodies(*part).len();
                assert!(part_size <= self.islands.bodies(island).len(), "the largest part keeps the id");
                assert_eq!(self.islands.is_asleep(*part), asleep);
            }
            let parts = created.iter().chain([&island]).map(|part| self.islands.bodies(*part).len());
            assert_eq!(parts.sum::<usize>(), size);
        }
    }

    /// Islands contain whole components. After all islands are split, they equal the components.
    fn check(&self) {
        self.islands.validate();
        for (body, asleep) in &self.asleep {
            assert_eq!(self.islands.is_asleep(self.island(*body)), *asleep);
        }
        let components = self.components();
        for (body, lowest) in &components {
            assert_eq!(self.island(*body), self.island(*lowest), "a component lies in one island");
        }
        let listed: usize = self.islands.islands().map(|island| self.islands.bodies(island).len()).sum();
        assert_eq!(listed, self.asleep.len());

        let mut split = self.clone();
        split.split_all();
        split.islands.validate();
        let count = components.values().collect::<BTreeSet<_>>().len();
        assert_eq!(split.islands.len(), count, "islands are components after the split");
        assert!(split.islands.islands().all(|island| split.islands.removed(island) == 0));
        assert!(components.iter().all(|(body, lowest)| split.island(*body) == split.island(*lowest)));
        let links: usize = split.islands.islands().map(|island| split.islands.links(island).len()).sum();
        assert_eq!(links, self.links.len());
    }

    /// One random operation. `density` is the intended number of links per 10 bodies.
    fn operate(&mut self, (kind, x, y): (u8, u32, u32), bodies: u32, density: usize) {
        let nth = |n: u32| self.asleep.keys().nth(n as usize % self.asleep.len().max(1)).copied();
        let (Some(a), Some(b)) = (nth(x), nth(y)) else { return self.add(x % bodies) };
        match kind {
            0..5 if !self.asleep.contains_key(&(x % bodies)) => self.add(x % bodies),
            5..8 => self.remove(a),
            8..14 => self.set_asleep(self.island(a), y % 2 == 0),
            14..18 => {
                self.islands.split(self.island(a));
            }
            _ if self.links.len() * 10 < self.asleep.len() * density || kind < 40 => {
                let key = (0..).map(|k| y.wrapping_add(k) % 1000).find(|key| !self.links.contains_key(key));
                self.link(key.expect("fewer links than keys"), a, b);
            }
            _ => {
                let key = self.links.keys().nth(x as usize % self.links.len().max(1)).copied();
                key.into_iter().for_each(|key| self.unlink(key));
            }
        }
    }
}

#[test]
fn the_smaller_island_merges_into_the_larger() {
    let mut world = World::with_bodies(6);
    let ids: Vec<IslandId> = (0..6).map(|body| world.island(body)).collect();
    world.link(0, 4, 1);
    assert_eq!(world.island(4), ids[1], "a tie goes to the lower id");
    world.link(1, 0, 4);
    assert_eq!(world.island(0), ids[1], "size beats id");
    assert_eq!(world.islands.bodies(ids[1]), [1, 4, 0]);
    assert_eq!(world.islands.bodies(ids[0]), []);
    world.add(6);
    assert_eq!(world.island(6), ids[0], "the lowest free id comes first");
    world.check();
}

#[test]
fn a_ring_survives_one_cut_and_falls_apart_at_two() {
    let mut world = World::with_bodies(10);
    (0..10).for_each(|k| world.link(k, k, (k + 1) % 10));
    let ring = world.island(0);
    world.unlink(2);
    assert_eq!((world.islands.removed(ring), world.islands.split(ring).len()), (1, 0));
    assert_eq!(world.islands.removed(ring), 0, "still connected");
    world.unlink(6);
    assert_eq!(world.islands.bodies(ring).len(), 10, "whole until it is split");
    world.set_asleep(ring, true);
    // The parts are 3..=6 and 7, 8, 9, 0, 1, 2: the larger part keeps the id.
    let created = world.islands.split(ring).to_vec();
    assert_eq!(created, [world.island(3)]);
    assert_eq!((world.island(7), world.islands.bodies(created[0])), (ring, &[3, 4, 5, 6][..]));
    assert!(world.islands.awake_islands().is_empty());
    world.check();
}

#[test]
fn unknown_names_are_answered() {
    let mut islands = Islands::new();
    let nobody = IslandId(7);
    assert!(islands.bodies(nobody).is_empty() && islands.links(nobody).is_empty() && islands.is_empty());
    assert!(!islands.is_asleep(nobody) && islands.removed(nobody) == 0 && islands.split(nobody).is_empty());
    islands.set_asleep(nobody, true);
    islands.remove_body(3);
    assert!(!islands.unlink(LinkId(3)) && islands.island_of(3).is_none());
    assert_eq!(islands, Islands::new());
}

/// Linking a sleeping island panics in debug builds. In release builds the merged island is awake.
#[test]
#[cfg_attr(debug_assertions, should_panic(expected = "must be woken"))]
fn linking_a_sleeper_unwoken() {
    let mut islands = Islands::new();
    let ids = [0, 1, 2].map(|body| islands.add_body(body));
    islands.link(LinkId(0), 0, 1);
    islands.set_asleep(ids[0], true);
    islands.link(LinkId(1), 1, 2);
    assert!(!islands.is_asleep(ids[0]));
    islands.validate();
}

/// Removing a linked body panics in debug builds. In release builds the links are removed with the body.
#[test]
#[cfg_attr(debug_assertions, should_panic(expected = "must be unlinked"))]
fn removing_a_linked_body() {
    let mut islands = Islands::new();
    for body in 0..4 {
        islands.add_body(body);
    }
    for k in 0..3 {
        islands.link(LinkId(k), k, k + 1);
    }
    islands.remove_body(1);
    islands.validate();
    assert_eq!(islands.links(islands.island_of(2).unwrap()), [IslandLink { key: LinkId(2), a: 2, b: 3 }]);
}

/// A second pass through the same states grows no buffer.
#[test]
fn a_steady_state_does_not_allocate() {
    let mut islands = Islands::new();
    for body in 0..100 {
        islands.add_body(body);
    }
    let lap = |islands: &mut Islands| {
        for k in 0..99 {
            islands.link(LinkId(k), k, k + 1);
        }
        for k in 0..99 {
            islands.unlink(LinkId(k));
        }
        islands.split(islands.island_of(0).unwrap());
        assert_eq!(islands.len(), 100);
    };
    let memory = |islands: &Islands| {
        let slots = islands.islands.iter().map(|i| i.bodies.capacity() + i.links.capacity());
        let tables = islands.members.capacity() + islands.link_places.capacity();
        let spare = islands.spare.iter().map(|(bodies, links)| bodies.capacity() + links.capacity());
        let lists = islands.awake.capacity() + islands.spare.capacity();
        slots.sum::<usize>() + spare.sum::<usize>() + lists + tables
    };
    // Ids change between passes. After some passes every slot was used.
    (0..200).for_each(|_| lap(&mut islands));
    let before = memory(&islands);
    (0..200).for_each(|_| lap(&mut islands));
    assert_eq!(memory(&islands), before);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10, max_shrink_iters: 2_000, ..ProptestConfig::default() })]

    #[test]
    fn islands_are_components_through_long_histories(
        operations in prop::collection::vec((0u8..100, any::<u32>(), any::<u32>()), 20_000..20_100),
        bodies in 2u32..150,
        density in 3usize..16,
    ) {
        let mut world = World::default();
        for (step, operation) in operations.into_iter().enumerate() {
            world.operate(operation, bodies, density);
            if step % 100 == 0 {
                world.check();
            }
        }
        world.check();
        let all: Vec<u32> = world.asleep.keys().copied().collect();
        all.into_iter().for_each(|body| world.remove(body));
        world.islands.validate();
        prop_assert!(world.islands.is_empty() && world.islands.awake_islands().is_empty());
    }

    /// A clone taken midway and the original end in equal states, including ids and orders.
    #[test]
    fn a_clone_goes_on_like_the_original(
        operations in prop::collection::vec((0u8..100, any::<u32>(), any::<u32>()), 2_000),
        bodies in 2u32..60,
    ) {
        let mut world = World::default();
        let (first, second) = operations.split_at(1_000);
        first.iter().for_each(|operation| world.operate(*operation, bodies, 9));
        let mut clone = world.clone();
        second.iter().for_each(|operation| world.operate(*operation, bodies, 9));
        second.iter().for_each(|operation| clone.operate(*operation, bodies, 9));
        prop_assert_eq!(world.islands, clone.islands);
    }
}
