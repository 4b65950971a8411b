//! Which islands may fall asleep, and which one should be checked for having fallen apart.

use super::{IslandId, Islands};

/// The outcome of one scan over the awake islands; keeps its memory between scans.
///
/// An island falls asleep as a whole, once every body of it has been at rest long enough. One that lost
/// links since it was last known to be connected may hold bodies that no longer touch: it must be
/// [split](Islands::split) before it may sleep. Splitting costs the whole island, so only one is
/// proposed per scan: the one with the body that has waited longest (after Catto, "Simulation Islands",
/// 2023). As a split settles the question, the next scan proposes another and nobody waits for ever.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SleepScan {
    sleepers: Vec<IslandId>,
    split: Option<IslandId>,
}

impl SleepScan {
    /// A scan that has seen nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Looks at all awake islands. `rested` tells for how many seconds a body has been at rest, `None` if
    /// it must not sleep; a body is ready to sleep from `time_to_sleep` seconds on. A NaN keeps awake.
    ///
    /// The outcome depends on the contents of the islands only, not on their history.
    pub fn scan(&mut self, islands: &Islands, time_to_sleep: f32, rested: impl Fn(u32) -> Option<f32>) {
        let ready = |body: &u32| rested(*body).filter(|time| *time >= time_to_sleep);
        self.sleepers.clear();
        let mut longest: Option<(f32, IslandId)> = None;
        for &island in islands.awake_islands() {
            let bodies = islands.bodies(island);
            if islands.removed(island) == 0 {
                if bodies.iter().all(|body| ready(body).is_some()) {
                    self.sleepers.push(island);
                }
                continue;
            }
            for time in bodies.iter().filter_map(ready) {
                let sleepier = longest.is_none_or(|(best, id)| time > best || (time == best && island < id));
                if sleepier {
                    longest = Some((time, island));
                }
            }
        }
        self.sleepers.sort_unstable();
        self.split = longest.map(|(_, island)| island);
    }

    /// The islands that may be put to sleep, by ascending id. They are known to be connected.
    pub fn sleepers(&self) -> &[IslandId] {
        &self.sleepers
    }

    /// The island to split in this step, never one of the sleepers.
    pub fn split(&self) -> Option<IslandId> {
        self.split
    }
}

#[cfg(test)]
mod tests {
    use super::super::LinkId;
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    fn chain(bodies: u32) -> Islands {
        let mut islands = Islands::new();
        (0..bodies).for_each(|body| {
            islands.add_body(body);
        });
        (1..bodies).for_each(|body| {
            islands.link(LinkId(body), body - 1, body);
        });
        islands
    }

    #[test]
    fn one_restless_body_keeps_its_island_awake() {
        let islands = chain(10);
        let mut scan = SleepScan::new();
        for (last, sleeps) in [(Some(0.5), true), (Some(0.49), false), (None, false), (Some(f32::NAN), false)]
        {
            scan.scan(&islands, 0.5, |body| if body == 9 { last } else { Some(3.0) });
            assert_eq!(scan.sleepers().len(), usize::from(sleeps), "{last:?}");
            assert_eq!(scan.split(), None);
        }
        scan.scan(&islands, f32::NAN, |_| Some(3.0));
        assert!(scan.sleepers().is_empty());
    }

    /// The quiet half of a chain that was cut sleeps after one split, the moving half does not.
    #[test]
    fn a_cut_chain_is_split_before_its_quiet_half_sleeps() {
        let mut islands = chain(10);
        let rested = |body| Some(if body < 4 { 1.0 } else { 0.0 });
        let mut scan = SleepScan::new();
        scan.scan(&islands, 0.5, rested);
        assert_eq!((scan.sleepers(), scan.split()), (&[][..], None));
        islands.unlink(LinkId(4));
        scan.scan(&islands, 0.5, rested);
        assert_eq!((scan.sleepers(), scan.split()), (&[][..], islands.island_of(0)));
        assert_eq!(islands.split(scan.split().unwrap()).len(), 1);
        scan.scan(&islands, 0.5, rested);
        assert_eq!((scan.sleepers(), scan.split()), (&[islands.island_of(3).unwrap()][..], None));
    }

    proptest! {
        /// Against the definition, over all bodies; and independent of the order of the awake list.
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
            scan.scan(&islands, 4.0, rested);

            let mut may_sleep: BTreeMap<IslandId, bool> = BTreeMap::new();
            let mut candidates: Vec<(u8, IslandId)> = Vec::new();
            for body in 0..40u32 {
                let island = islands.island_of(body).unwrap();
                if islands.is_asleep(island) {
                    continue;
                }
                let ready = times[body as usize].is_some_and(|time| time >= 4);
                *may_sleep.entry(island).or_insert(islands.removed(island) == 0) &= ready;
                if ready && islands.removed(island) > 0 {
                    candidates.push((u8::MAX - times[body as usize].unwrap(), island));
                }
            }
            let expected: Vec<_> = may_sleep.into_iter().filter(|(_, may)| *may).map(|(id, _)| id).collect();
            prop_assert_eq!(scan.sleepers(), &expected[..]);
            prop_assert_eq!(scan.split(), candidates.into_iter().min().map(|(_, island)| island));

            for body in shuffle {
                let island = islands.island_of(body).unwrap();
                if !islands.is_asleep(island) {
                    islands.set_asleep(island, true);
                    islands.set_asleep(island, false);
                }
            }
            let mut again = SleepScan::new();
            again.scan(&islands, 4.0, rested);
            prop_assert_eq!(scan, again);
        }
    }
}
