//! A hash map from unordered pairs of ids: from two colliders to their contact.

use super::prefetch;

/// Maps pairs of `u32` ids to a `u32`. `(a, b)` and `(b, a)` are the same pair.
///
/// Open addressing at a load of at most one half with linear probing: most look-ups read one cache line.
/// Removal shifts the rest of the run back, so there are no tombstones, and a map that stays at one size is
/// never rehashed. There is no iteration: results would depend on the order of hashes.
#[derive(Clone, Debug, Default)]
pub struct PairSet {
    /// Empty or a power of two long.
    slots: Vec<Slot>,
    len: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Slot {
    /// Lower id, higher id; [`VACANT`] in a free slot.
    pair: [u32; 2],
    value: u32,
}

/// The pair of a free slot. Two different ids never equal it.
const VACANT: [u32; 2] = [u32::MAX; 2];
const FREE: Slot = Slot { pair: VACANT, value: 0 };
const MIN_SLOTS: usize = 16;

impl PairSet {
    /// The bytes of a slot. There are two to four slots for each pair.
    pub const BYTES_PER_SLOT: usize = size_of::<Slot>();

    /// An empty map without storage.
    pub const fn new() -> Self {
        Self { slots: Vec::new(), len: 0 }
    }

    /// Maps a pair to a value. Returns the value it had. The pair `(u32::MAX, u32::MAX)` cannot be stored:
    /// inserting it does nothing.
    pub fn insert(&mut self, a: u32, b: u32, value: u32) -> Option<u32> {
        let pair = ordered(a, b);
        debug_assert!(pair != VACANT, "the pair of two u32::MAX cannot be stored");
        if pair == VACANT {
            return None;
        }
        if (self.len + 1) * 2 > self.slots.len() {
            self.rehash((self.slots.len() * 2).max(MIN_SLOTS));
        }
        let at = find(&self.slots, pair);
        let slot = &mut self.slots[at];
        let old = (slot.pair == pair).then_some(slot.value);
        *slot = Slot { pair, value };
        self.len += usize::from(old.is_none());
        old
    }

    /// The value of a pair.
    #[inline]
    pub fn get(&self, a: u32, b: u32) -> Option<u32> {
        let pair = ordered(a, b);
        if self.slots.is_empty() || pair == VACANT {
            return None;
        }
        let slot = self.slots[find(&self.slots, pair)];
        (slot.pair == pair).then_some(slot.value)
    }

    /// Prefetches the slot of a pair.
    #[inline]
    pub fn prefetch(&self, a: u32, b: u32) {
        if !self.slots.is_empty() {
            prefetch(&self.slots, (mix(ordered(a, b)) as usize & (self.slots.len() - 1)) as u32);
        }
    }

    /// Whether the pair has a value.
    #[inline]
    pub fn contains(&self, a: u32, b: u32) -> bool {
        self.get(a, b).is_some()
    }

    /// Removes a pair. Returns the value it had.
    pub fn remove(&mut self, a: u32, b: u32) -> Option<u32> {
        let pair = ordered(a, b);
        if self.slots.is_empty() || pair == VACANT {
            return None;
        }
        let mut hole = find(&self.slots, pair);
        let removed = self.slots[hole];
        if removed.pair != pair {
            return None;
        }
        // Pairs further in this run whose probe passes the hole move into it.
        let mask = self.slots.len() - 1;
        let mut at = hole;
        loop {
            at = (at + 1) & mask;
            let slot = self.slots[at];
            if slot.pair == VACANT {
                break;
            }
            let home = mix(slot.pair) as usize & mask;
            if (at.wrapping_sub(home) & mask) >= (at.wrapping_sub(hole) & mask) {
                self.slots[hole] = slot;
                hole = at;
            }
        }
        self.slots[hole] = FREE;
        self.len -= 1;
        Some(removed.value)
    }

    /// The number of pairs.
    #[inline]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Grows to a capacity of `pairs` pairs in all, so inserting them does not allocate.
    pub fn reserve(&mut self, pairs: usize) {
        let slots = (pairs * 2).next_power_of_two().max(MIN_SLOTS);
        if slots > self.slots.len() {
            self.rehash(slots);
        }
    }

    /// Gives back the storage of pairs that were removed.
    pub fn shrink(&mut self) {
        let slots = (self.len * 2).next_power_of_two().max(MIN_SLOTS);
        if slots < self.slots.len() {
            self.rehash(slots);
        }
    }

    /// Removes all pairs and keeps the storage.
    pub fn clear(&mut self) {
        self.slots.fill(FREE);
        self.len = 0;
    }

    fn rehash(&mut self, slots: usize) {
        let old = core::mem::replace(&mut self.slots, vec![FREE; slots]);
        for slot in old.into_iter().filter(|s| s.pair != VACANT) {
            let at = find(&self.slots, slot.pair);
            self.slots[at] = slot;
        }
    }
}

#[inline(always)]
fn ordered(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The slot of the pair, or the free slot that ends its run. The loop ends because half of the slots are
/// free.
#[inline(always)]
fn find(slots: &[Slot], pair: [u32; 2]) -> usize {
    let mask = slots.len() - 1;
    let mut at = mix(pair) as usize & mask;
    while slots[at].pair != pair && slots[at].pair != VACANT {
        at = (at + 1) & mask;
    }
    at
}

/// Spreads a pair over all bits by two rounds of multiply and xor-shift, each a bijection of `u64`. The
/// factors are the fractional digits of √2 and √3, which are odd.
#[inline(always)]
fn mix(pair: [u32; 2]) -> u64 {
    let mut x = u64::from(pair[0]) << 32 | u64::from(pair[1]);
    x = (x ^ (x >> 32)).wrapping_mul(0x6A09_E667_F3BC_C909);
    x = (x ^ (x >> 29)).wrapping_mul(0xBB67_AE85_84CA_A73B);
    x ^ (x >> 32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::HashMap;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8))]
        #[test]
        fn behaves_as_a_std_map(
            range in prop_oneof![2..12u32, Just(100u32)],
            ops in prop::collection::vec((0..16u8, any::<u32>(), any::<u32>(), any::<u32>()), 20_000),
        ) {
            let (mut set, mut model) = (PairSet::new(), HashMap::new());
            for (kind, a, b, value) in ops {
                let (a, b) = (a % range, b % range);
                let key = (a.min(b), a.max(b));
                match kind {
                    0..=6 => prop_assert_eq!(set.insert(a, b, value), model.insert(key, value)),
                    7..=12 => prop_assert_eq!(set.remove(a, b), model.remove(&key)),
                    _ => prop_assert_eq!(set.get(a, b), model.get(&key).copied()),
                }
                prop_assert_eq!(set.len(), model.len());
                prop_assert!(set.slots.is_empty() || set.len() * 2 <= set.slots.len());
            }
            for a in 0..range {
                for b in a..range {
                    prop_assert_eq!(set.get(a, b), model.get(&(a, b)).copied());
                }
            }
        }
    }

    #[test]
    fn a_map_of_constant_size_keeps_its_storage() {
        let mut set = PairSet::new();
        set.reserve(1000);
        let slots = set.slots.len();
        for k in 0..100_000u32 {
            set.insert(k, k + 7, k);
            if k >= 1000 {
                assert_eq!(set.remove(k - 1000 + 7, k - 1000), Some(k - 1000));
            }
        }
        assert!(set.slots.len() <= slots * 2 && set.len() == 1000);
        (0..900).for_each(|k| _ = set.remove(99_999 - k, 99_999 - k + 7));
        set.shrink();
        assert!(set.slots.len() == 256 && (99_000..99_100).all(|k| set.get(k, k + 7) == Some(k)));
        set.clear();
        assert!(set.is_empty() && set.slots.iter().all(|s| *s == FREE));
    }

    #[test]
    fn neighbouring_pairs_land_in_short_runs() {
        // The contacts of a pyramid: every id with a few neighbours. With a good hash the mean number of
        // probes at half load is 1.5 (Knuth, vol. 3, 6.4); a poor hash clusters.
        let mut set = PairSet::new();
        set.reserve(1 << 15);
        for a in 0..8192u32 {
            (1..5).for_each(|d| {
                set.insert(a, a + d * d, 0);
            });
        }
        let mask = set.slots.len() - 1;
        let probes: usize = set
            .slots
            .iter()
            .enumerate()
            .filter(|(_, s)| s.pair != VACANT)
            .map(|(i, s)| (i.wrapping_sub(mix(s.pair) as usize) & mask) + 1)
            .sum();
        let mean = probes as f64 / set.len() as f64;
        assert!(mean < 1.6, "mean probe length {mean}");
    }

    #[test]
    fn an_absent_pair_is_absent() {
        let mut set = PairSet::new();
        assert_eq!((set.get(1, 2), set.remove(1, 2)), (None, None));
        assert_eq!(set.insert(u32::MAX, 0, 5), None);
        assert_eq!(set.get(0, u32::MAX), Some(5));
        assert_eq!((set.get(u32::MAX, u32::MAX), set.remove(u32::MAX, u32::MAX)), (None, None));
    }
}
