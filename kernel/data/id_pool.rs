//! Allocates and frees small ids.

use super::BitSet;

/// Small dense ids, reused lowest first, but not before the next [`recycle`](Self::recycle).
///
/// The next id depends only on the ids in use, not on the order in which others were allocated and freed. The
/// order of ids is the order of work, so a level that is loaded again gives the same bits.
///
/// A freed id is neither live nor allocated again before it is recycled. So an id that is still held from
/// this step is not live, instead of naming another object.
///
/// *Ids aside.* Objects that take no part in the ordered work get their ids from
/// [`allocate_aside`](Self::allocate_aside). Both kinds share the numbers, but each kind reuses its own only.
/// So objects aside never change the order of the others: with and without them, the others get ids in the
/// same order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct IdPool {
    live: BitSet,
    /// Reusable ordinary ids, and reusable ids aside.
    free: [Free; 2],
    /// All ids aside, live or not.
    aside: BitSet,
    pending: Vec<u32>,
    capacity: u32,
}

/// Reusable ids of one kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Free {
    ids: BitSet,
    count: u32,
    /// No id below this one is free.
    lowest: u32,
}

impl Free {
    const fn new() -> Self {
        Self { ids: BitSet::new(), count: 0, lowest: 0 }
    }

    fn take_lowest(&mut self) -> Option<u32> {
        let id = if self.count == 0 { None } else { self.ids.first_from(self.lowest) }?;
        self.ids.remove(id);
        self.count -= 1;
        self.lowest = id + 1;
        Some(id)
    }

    fn add(&mut self, id: u32) {
        self.ids.insert(id);
        self.count += 1;
        self.lowest = self.lowest.min(id);
    }
}

impl IdPool {
    /// An empty pool.
    pub const fn new() -> Self {
        Self {
            live: BitSet::new(),
            free: [Free::new(), Free::new()],
            aside: BitSet::new(),
            pending: Vec::new(),
            capacity: 0,
        }
    }

    /// Allocates the lowest reusable id, or if there is none the next id that was never allocated.
    pub fn allocate(&mut self) -> u32 {
        self.allocate_of(false)
    }

    /// The same for an object that takes no part in the ordered work.
    pub fn allocate_aside(&mut self) -> u32 {
        self.allocate_of(true)
    }

    fn allocate_of(&mut self, aside: bool) -> u32 {
        let id = self.free[usize::from(aside)].take_lowest().unwrap_or_else(|| {
            self.capacity += 1;
            if aside {
                self.aside.insert(self.capacity - 1);
            }
            self.capacity - 1
        });
        self.live.insert(id);
        id
    }

    /// Frees an id; [`recycle`](Self::recycle) makes it reusable. Freeing an id that is not live is a bug of
    /// the caller, and ignored in release builds.
    pub fn free(&mut self, id: u32) {
        let was_live = self.live.remove(id);
        debug_assert!(was_live, "id {id} is freed but not live");
        if was_live {
            self.pending.push(id);
        }
    }

    /// Makes the ids freed so far reusable.
    pub fn recycle(&mut self) {
        for id in self.pending.drain(..) {
            self.free[usize::from(self.aside.contains(id))].add(id);
        }
    }

    /// Forgets the reusable ids above the highest live id. The order of the next allocated ids stays the
    /// same. Call it after freed ids were [recycled](Self::recycle).
    pub fn trim(&mut self) {
        debug_assert!(self.pending.is_empty(), "freed ids were recycled");
        if !self.pending.is_empty() {
            return;
        }
        self.capacity = self.span() as u32;
        let capacity = self.capacity as usize;
        [&mut self.live, &mut self.aside].into_iter().for_each(|ids| ids.truncate(capacity));
        for free in &mut self.free {
            free.ids.truncate(capacity);
            free.count = free.ids.count() as u32;
            free.lowest = free.lowest.min(self.capacity);
        }
        self.pending.shrink_to_fit();
    }

    /// One more than the highest id in use.
    pub fn span(&self) -> usize {
        self.live.last().map_or(0, |last| last as usize + 1)
    }

    /// Whether the id is in use.
    #[inline]
    pub fn is_live(&self, id: u32) -> bool {
        self.live.contains(id)
    }

    /// The number of live ids.
    #[inline]
    pub fn len(&self) -> usize {
        let free: u32 = self.free.iter().map(|free| free.count).sum();
        self.capacity as usize - free as usize - self.pending.len()
    }

    /// Whether no id is live.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One more than the highest id ever allocated: the length of a table indexed by these ids.
    #[inline]
    pub fn capacity(&self) -> usize {
        self.capacity as usize
    }

    /// The live ids in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        self.live.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8))]
        #[test]
        fn never_gives_out_a_live_or_pending_id(ops in prop::collection::vec((0..20u8, any::<u32>()), 10_000)) {
            let mut pool = IdPool::new();
            let (mut live, mut pending, mut free) = (Vec::<u32>::new(), Vec::new(), BTreeSet::new());
            let mut highest = 0;
            for (kind, pick) in ops {
                match kind {
                    0..=9 => {
                        let expected = free.pop_first().unwrap_or(highest);
                        highest = highest.max(expected + 1);
                        prop_assert_eq!(pool.allocate(), expected);
                        live.push(expected);
                    }
                    10..=18 if !live.is_empty() => {
                        let id = live.swap_remove(pick as usize % live.len());
                        pool.free(id);
                        pending.push(id);
                        prop_assert!(!pool.is_live(id));
                    }
                    _ => {
                        pool.recycle();
                        free.extend(pending.drain(..));
                        if pick % 4 == 0 {
                            pool.trim();
                            highest = live.iter().max().map_or(0, |last| last + 1);
                            free.split_off(&highest);
                        }
                    }
                }
                prop_assert_eq!(pool.len(), live.len());
                prop_assert_eq!(pool.capacity(), highest as usize);
                prop_assert_eq!(pool.is_empty(), live.is_empty());
                let id = pick % (highest + 2);
                prop_assert_eq!(pool.is_live(id), live.contains(&id));
            }
            let model: BTreeSet<u32> = live.into_iter().collect();
            prop_assert!(pool.iter().eq(model.into_iter()));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// Two pools, one of them with objects aside. The other objects get ids in the same order in both.
        #[test]
        fn ids_aside_do_not_change_the_order_of_others(
            ops in prop::collection::vec((0..20u8, any::<u32>()), 500),
        ) {
            let (mut alone, mut both) = (IdPool::new(), IdPool::new());
            let (mut pairs, mut aside) = (Vec::<(u32, u32)>::new(), Vec::<u32>::new());
            for (kind, pick) in ops {
                match kind {
                    0..=5 => pairs.push((alone.allocate(), both.allocate())),
                    6..=10 => aside.push(both.allocate_aside()),
                    11..=14 if !pairs.is_empty() => {
                        let (one, other) = pairs.swap_remove(pick as usize % pairs.len());
                        alone.free(one);
                        both.free(other);
                    }
                    15..=17 if !aside.is_empty() => both.free(aside.swap_remove(pick as usize % aside.len())),
                    _ => {
                        alone.recycle();
                        both.recycle();
                        if pick % 3 == 0 {
                            both.trim();
                        }
                    }
                }
                pairs.sort_unstable();
                prop_assert!(pairs.is_sorted_by_key(|(_, other)| *other));
                prop_assert_eq!(both.len(), pairs.len() + aside.len());
            }
        }
    }

    #[test]
    fn a_freed_id_returns_only_after_recycling_lowest_first() {
        let mut pool = IdPool::new();
        let ids = [pool.allocate(), pool.allocate(), pool.allocate()];
        assert_eq!(ids, [0, 1, 2]);
        pool.free(0);
        pool.free(2);
        assert_eq!(pool.allocate(), 3);
        pool.recycle();
        assert_eq!([pool.allocate(), pool.allocate(), pool.allocate()], [0, 2, 4]);
    }

    #[test]
    fn a_clone_goes_its_own_way_from_the_same_state() {
        let mut pool = IdPool::new();
        (0..5).for_each(|_| {
            pool.allocate();
        });
        pool.free(3);
        pool.recycle();
        let mut other = pool.clone();
        assert_eq!(pool.allocate(), other.allocate());
        pool.free(1);
        assert!(other.is_live(1));
    }

    #[test]
    #[cfg_attr(debug_assertions, should_panic(expected = "not live"))]
    fn a_double_free_is_caught_or_ignored() {
        let mut pool = IdPool::new();
        let id = pool.allocate();
        pool.free(id);
        pool.free(id);
        pool.recycle();
        assert_eq!([pool.allocate(), pool.allocate()], [0, 1]);
    }
}
