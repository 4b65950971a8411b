//! The search for islands that may fall asleep, and for islands that may have split.

use super::{IslandId, Islands};

/// Maximum number of bodies and links of the islands that are split in one step, not counting the first
/// island. It bounds the time of splitting small islands to about 0.05 ms a step. With a smaller budget,
/// hundreds of islands that fall apart at once stay awake longer.
const SPLIT_BUDGET: usize = 4096;

/// The outcome of one scan over the awake islands; keeps its memory between scans.
///
/// An island falls asleep as a whole, once every body has been at rest long enough. An island that lost links
/// may have fallen apart: it must be [split](Islands::split) before it may sleep (Catto, "Simulation
/// Islands", 2023).
///
/// Decision: a split visits the whole island, and a large heap may lose a link in every step. So islands with
/// a body that is ready to sleep take turns by id: the first island is split at any size, others only within
/// a budget. The first island that is skipped has the next turn. Box2D splits the island whose body has
/// rested longest; there a heap that keeps losing links keeps all other islands awake.
#[derive(Clone, Debug, PartialEq)]
pub struct SleepScan {
    sleepers: Vec<IslandId>,
    /// Islands that may be split, starting with the one whose turn it is.
    candidates: Vec<IslandId>,
    splits: Vec<IslandId>,
    budget: usize,
}

impl Default for SleepScan {
    fn default() -> Self {
        Self { sleepers: Vec::new(), candidates: Vec::new(), splits: Vec::new(), budget: SPLIT_BUDGET }
    }
}

impl SleepScan {
    /// An empty scan.
    pub fn new() -> Self {
        Self::default()
    }

    /// Scans all awake islands. `rested` returns the seconds for which a body has been at rest, `None` if it
    /// must not sleep. A body is ready to sleep after `time_to_sleep` seconds; NaN keeps it awake.
    /// [Woken](Islands::is_woken) islands are skipped.
    ///
    /// The outcome depends only on the islands, which also store whose turn it is.
    pub fn scan(&mut self, islands: &mut Islands, time_to_sleep: f32, rested: impl Fn(u32) -> Option<f32>) {
        let ready = |body: &u32| rested(*body).is_some_and(|time| time >= time_to_sleep);
        self.sleepers.clear();
        self.candidates.clear();
        for &island in islands.awake_islands() {
            if islands.is_woken(island) {
                continue;
            }
            let bodies = islands.bodies(island);
            if islands.removed(island) > 0 {
                if bodies.iter().any(ready) {
                    self.candidates.push(island);
                }
            } else if bodies.iter().all(ready) {
                self.sleepers.push(island);
            }
        }
        self.sleepers.sort_unstable();
        self.candidates.sort_unstable();
        self.choose_splits(islands);
    }

    fn choose_splits(&mut self, islands: &mut Islands) {
        let turn = islands.split_turn();
        let first = self.candidates.partition_point(|island| *island < turn);
        self.candidates.rotate_left(first);
        self.splits.clear();
        let mut left = self.budget;
        let mut passed_over = None;
        for (i, &island) in self.candidates.iter().enumerate() {
            let cost = islands.bodies(island).len() + islands.links(island).len();
            if i == 0 {
                self.splits.push(island);
            } else if cost <= left {
                left -= cost;
                self.splits.push(island);
            } else if passed_over.is_none() {
                passed_over = Some(island);
            }
        }
        if let Some(next) = passed_over {
            islands.set_split_turn(next);
        }
    }

    /// The islands to put to sleep, by ascending id. Each is connected.
    pub fn sleepers(&self) -> &[IslandId] {
        &self.sleepers
    }

    /// The islands to split in this step, none of them among the sleepers.
    pub fn splits(&self) -> &[IslandId] {
        &self.splits
    }
}

#[cfg(test)]
mod tests {
    use super::super::LinkId;
    use super::*;
    use proptest::prelude::*;
    use std::collections::{BTreeMap, BTreeSet};

    fn chain(bodies: u32) -> Islands {
        let mut islands = Islands::new();
        add_chain(&mut islands, 0..bodies);
        islands
    }

    /// Adds a chain of bodies. Each link has the number of its second body.
    fn add_chain(islands: &mut Islands, bodies: core::ops::Range<u32>) {
        for body in bodies.clone() {
            islands.add_body(body);
            if body > bodies.start {
                islands.link(LinkId(body), body - 1, body);
            }
        }
    }

    /// One step without contacts: split, then sleep.
    fn step(scan: &mut SleepScan, islands: &mut Islands, rested: impl Fn(u32) -> Option<f32>) {
        scan.scan(islands, 0.5, rested);
        for island in scan.splits() {
            islands.split(*island);
        }
        for island in scan.sleepers() {
            islands.set_asleep(*island, true);
        }
    }

    fn sleeps(islands: &Islands, body: u32) -> bool {
        islands.is_asleep(islands.island_of(body).unwrap())
    }

    #[test]
    fn one_restless_body_keeps_its_island_awake() {
        let mut islands = chain(10);
        let mut scan = SleepScan::new();
        for (last, sleeps) in [(Some(0.5), true), (Some(0.49), false), (None, false), (Some(f32::NAN), false)]
        {
            scan.scan(&mut islands, 0.5, |body| if body == 9 { last } else { Some(3.0) });
            assert_eq!(scan.sleepers().len(), usize::from(sleeps), "{last:?}");
            assert_eq!(scan.splits(), []);
        }
        scan.scan(&mut islands, f32::NAN, |_| Some(3.0));
        assert!(scan.sleepers().is_empty());
    }

    /// The resting half of a chain that was cut sleeps after one split, the moving half does not.
    #[test]
    fn a_cut_chain_is_split_before_its_quiet_half_sleeps() {
        let mut islands = chain(10);
        let rested = |body| Some(if body < 4 { 1.0 } else { 0.0 });
        let mut scan = SleepScan::new();
        scan.scan(&mut islands, 0.5, rested);
        assert_eq!((scan.sleepers(), scan.splits()), (&[][..], &[][..]));
        islands.unlink(LinkId(4));
        scan.scan(&mut islands, 0.5, rested);
        let [island] = scan.splits() else { panic!("{:?}", scan.splits()) };
        assert_eq!((scan.sleepers(), Some(*island)), (&[][..], islands.island_of(0)));
        assert_eq!(islands.split(*island).len(), 1);
        scan.scan(&mut islands, 0.5, rested);
        assert_eq!((scan.sleepers(), scan.splits()), (&[islands.island_of(3).unwrap()][..], &[][..]));
    }

    /// The heap has rested longest. If rest time decided, the heap would be split in every step, and no other
    /// island ever.
    #[test]
    fn parted_pairs_sleep_beside_a_heap_that_loses_a_link_in_every_step() {
        let mut islands = Islands::new();
        let heap = 0..5_000;
        add_chain(&mut islands, heap.clone());
        for pair in 0..20 {
            let a = heap.end + 2 * pair;
            add_chain(&mut islands, a..a + 2);
            islands.unlink(LinkId(a + 1));
        }
        let rested = |body: u32| {
            Some(if body + 1 == heap.end {
                0.0
            } else if body < heap.end {
                30.0
            } else {
                1.0
            })
        };
        let mut scan = SleepScan::new();
        for i in 0..3u32 {
            // Links two more neighbours, and removes the link again.
            islands.link(LinkId(10_000 + i), i, i + 1);
            islands.unlink(LinkId(10_000 + i));
            step(&mut scan, &mut islands, rested);
        }
        assert!((heap.end..heap.end + 40).all(|body| sleeps(&islands, body)));
        assert!(!sleeps(&islands, 0), "it hangs on a body that moves");
        islands.validate();
    }

    /// All three islands are large; each is split in every third step.
    #[test]
    fn large_islands_take_turns() {
        let mut islands = Islands::new();
        let heaps = [0, 3_000, 6_000].map(|start| start..start + 3_000);
        heaps.iter().for_each(|heap| add_chain(&mut islands, heap.clone()));
        let ids = heaps.clone().map(|heap| islands.island_of(heap.start).unwrap());
        let mut scan = SleepScan::new();
        for i in 0..9 {
            for heap in &heaps {
                islands.link(LinkId(10_000), heap.start, heap.start + 1);
                islands.unlink(LinkId(10_000));
            }
            // One body of each island has rested.
            step(&mut scan, &mut islands, |body| Some(if body % 3_000 == 0 { 1.0 } else { 0.0 }));
            assert_eq!(scan.splits(), [ids[i % 3]]);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

        /// A resting body without a chain of links to a moving body sleeps after at most one step per body,
        /// for any history of links and any split budget.
        #[test]
        fn all_that_could_sleep_does_so_in_bounded_time(
            count in 2u32..80,
            first in prop::collection::vec((any::<u32>(), any::<u32>()), 0..160),
            cut in prop::collection::vec(any::<bool>(), 160),
            moving in prop::collection::vec(prop::bool::weighted(0.3), 80),
            budget in 0usize..40,
            later in prop::collection::vec((any::<u32>(), any::<u32>()), 160),
        ) {
            let mut islands = Islands::new();
            (0..count).for_each(|body| { islands.add_body(body); });
            for (key, &(a, b)) in first.iter().enumerate() {
                islands.link(LinkId(key as u32), a % count, b % count);
            }
            let mut left = first;
            for key in (0..left.len()).rev().filter(|key| cut[*key]) {
                islands.unlink(LinkId(key as u32));
                left.remove(key);
            }
            // Moving bodies, and bodies connected with a moving body.
            let mut restless: Vec<bool> = moving[..count as usize].to_vec();
            for _ in 0..count {
                for &(a, b) in &left {
                    let (a, b) = ((a % count) as usize, (b % count) as usize);
                    let either = restless[a] || restless[b];
                    (restless[a], restless[b]) = (either, either);
                }
            }
            let movers: Vec<u32> = (0..count).filter(|body| restless[*body as usize]).collect();
            let mut scan = SleepScan { budget, ..SleepScan::new() };
            for i in 0..=count as usize {
                // Before islands are split, each moving body is next to a resting one.
                step(&mut scan, &mut islands, |body| Some(if moving[body as usize] { 0.0 } else { 1.0 }));
                if let [.., _] = movers[..] {
                    let (a, b) = later[i % later.len()];
                    let [a, b] = [a, b].map(|n| movers[n as usize % movers.len()]);
                    islands.link(LinkId(1_000), a, b);
                    islands.unlink(LinkId(1_000));
                }
            }
            for body in 0..count {
                prop_assert_eq!(sleeps(&islands, body), !restless[body as usize], "body {}", body);
            }
            islands.validate();
        }

        /// The scan against its definition, over all bodies, for any order of the awake list.
        #[test]
        fn the_scan_matches_its_definition(
            links in prop::collection::vec((0u32..40, 0u32..40), 0..40),
            cut in prop::collection::vec(any::<bool>(), 40),
            asleep in prop::collection::vec(0u32..40, 0..6),
            times in prop::collection::vec(prop::option::weighted(0.97, 2u8..10), 40),
            shuffle in prop::collection::vec(0u32..40, 0..80),
        ) {
            let mut islands = chain(0);
            (0..40).for_each(|body| { islands.add_body(body); });
            for (key, &(a, b)) in links.iter().enumerate() {
                islands.link(LinkId(key as u32), a, b);
            }
            for key in (0..links.len()).filter(|key| cut[*key] && key % 4 == 0) {
                islands.unlink(LinkId(key as u32));
            }
            for body in asleep {
                islands.set_asleep(islands.island_of(body).unwrap(), true);
            }
            let rested = |body: u32| times[body as usize].map(f32::from);
            let mut scan = SleepScan::new();
            scan.scan(&mut islands, 4.0, rested);

            let mut may_sleep: BTreeMap<IslandId, bool> = BTreeMap::new();
            let mut candidates: BTreeSet<IslandId> = BTreeSet::new();
            for body in 0..40u32 {
                let island = islands.island_of(body).unwrap();
                if islands.is_asleep(island) {
                    continue;
                }
                let ready = times[body as usize].is_some_and(|time| time >= 4);
                *may_sleep.entry(island).or_insert(islands.removed(island) == 0) &= ready;
                if ready && islands.removed(island) > 0 {
                    candidates.insert(island);
                }
            }
            let expected: Vec<_> = may_sleep.into_iter().filter(|(_, may)| *may).map(|(id, _)| id).collect();
            prop_assert_eq!(scan.sleepers(), &expected[..]);
            // All islands are small.
            prop_assert!(scan.splits().iter().eq(&candidates));

            for body in shuffle {
                let island = islands.island_of(body).unwrap();
                if !islands.is_asleep(island) {
                    islands.set_asleep(island, true);
                    islands.set_asleep(island, false);
                }
            }
            let mut again = SleepScan::new();
            again.scan(&mut islands, 4.0, rested);
            prop_assert_eq!(scan, again);
        }
    }
}
