//! A set of small ids, one bit each.

const BITS: usize = u64::BITS as usize;

/// A set of `u32`, as a bit per possible member. Grows to the largest id ever inserted.
#[derive(Clone, Debug, Default)]
pub struct BitSet {
    words: Vec<u64>,
}

impl BitSet {
    /// An empty set without storage.
    pub const fn new() -> Self {
        Self { words: Vec::new() }
    }

    /// Makes room for the ids below `capacity`, so inserting them does not allocate.
    pub fn grow(&mut self, capacity: usize) {
        let words = capacity.div_ceil(BITS);
        if words > self.words.len() {
            self.words.resize(words, 0);
        }
    }

    /// Adds an id. Returns whether it was absent.
    #[inline]
    pub fn insert(&mut self, id: u32) -> bool {
        let (word, bit) = split(id);
        if word >= self.words.len() {
            self.grow(id as usize + 1);
        }
        let absent = self.words[word] & bit == 0;
        self.words[word] |= bit;
        absent
    }

    /// Removes the ids from `capacity` on, and gives their storage back.
    pub fn truncate(&mut self, capacity: usize) {
        self.words.truncate(capacity.div_ceil(BITS));
        self.words.shrink_to_fit();
        if let (Some(last), rest @ 1..) = (self.words.get_mut(capacity / BITS), capacity % BITS) {
            *last &= (1 << rest) - 1;
        }
    }

    /// The highest member.
    pub fn last(&self) -> Option<u32> {
        let word = self.words.iter().rposition(|word| *word != 0)?;
        Some((word * BITS) as u32 + self.words[word].ilog2())
    }

    /// Removes an id. Returns whether it was present.
    #[inline]
    pub fn remove(&mut self, id: u32) -> bool {
        let (word, bit) = split(id);
        let Some(word) = self.words.get_mut(word) else { return false };
        let present = *word & bit != 0;
        *word &= !bit;
        present
    }

    /// Whether the id is in the set.
    #[inline]
    pub fn contains(&self, id: u32) -> bool {
        let (word, bit) = split(id);
        self.words.get(word).is_some_and(|w| w & bit != 0)
    }

    /// Removes all ids and keeps the storage.
    pub fn clear(&mut self) {
        self.words.fill(0);
    }

    /// The number of members. O(capacity).
    pub fn count(&self) -> usize {
        self.words.iter().map(|w| w.count_ones() as usize).sum()
    }

    /// Whether there is no member. O(capacity).
    pub fn is_empty(&self) -> bool {
        self.words.iter().all(|w| *w == 0)
    }

    /// Whether the sets have no id in common.
    pub fn is_disjoint(&self, other: &Self) -> bool {
        self.words.iter().zip(&other.words).all(|(a, b)| a & b == 0)
    }

    /// Adds all members of another set.
    pub fn union_with(&mut self, other: &Self) {
        self.grow(other.words.len() * BITS);
        for (word, more) in self.words.iter_mut().zip(&other.words) {
            *word |= more;
        }
    }

    /// The members in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        self.iter_block(self.words.len(), 0)
    }

    /// The lowest member that is not below `id`.
    pub fn first_from(&self, id: u32) -> Option<u32> {
        let (first, bit) = split(id);
        let mut mask = !(bit - 1);
        for (i, word) in self.words.iter().enumerate().skip(first) {
            let rest = word & mask;
            if rest != 0 {
                return Some((i * BITS) as u32 + rest.trailing_zeros());
            }
            mask = u64::MAX;
        }
        None
    }

    /// The number of blocks of `words` times 64 ids that cover all members.
    pub fn blocks(&self, words: usize) -> usize {
        self.words.len().div_ceil(words)
    }

    /// The members in one of [`blocks`](Self::blocks) in ascending order.
    pub fn iter_block(&self, words: usize, block: usize) -> impl Iterator<Item = u32> + '_ {
        self.words.iter().enumerate().skip(words * block).take(words).flat_map(|(i, &word)| {
            let mut rest = word;
            core::iter::from_fn(move || {
                (rest != 0).then(|| {
                    let bit = rest.trailing_zeros();
                    rest &= rest - 1;
                    (i * BITS) as u32 + bit
                })
            })
        })
    }
}

impl PartialEq for BitSet {
    /// Whether both have the same members. Their storage may differ.
    fn eq(&self, other: &Self) -> bool {
        let shared = self.words.len().min(other.words.len());
        self.words[..shared] == other.words[..shared]
            && self.words[shared..].iter().chain(&other.words[shared..]).all(|w| *w == 0)
    }
}

impl Eq for BitSet {}

#[inline(always)]
fn split(id: u32) -> (usize, u64) {
    (id as usize / BITS, 1 << (id as usize % BITS))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    #[derive(Clone, Debug)]
    enum Op {
        Insert(u32),
        Remove(u32),
        Contains(u32),
        Grow(usize),
        Clear,
        Union(Vec<u32>),
    }

    fn op() -> impl Strategy<Value = Op> {
        let id = || prop_oneof![0..200u32, 0..5000u32];
        prop_oneof![
            200 => id().prop_map(Op::Insert),
            150 => id().prop_map(Op::Remove),
            100 => id().prop_map(Op::Contains),
            5 => (0..6000usize).prop_map(Op::Grow),
            1 => Just(Op::Clear),
            5 => prop::collection::vec(id(), 0..20).prop_map(Op::Union),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8))]
        #[test]
        fn behaves_as_a_std_set(ops in prop::collection::vec(op(), 10_000)) {
            let (mut set, mut model) = (BitSet::new(), BTreeSet::new());
            for (step, op) in ops.into_iter().enumerate() {
                match op {
                    Op::Insert(id) => prop_assert_eq!(set.insert(id), model.insert(id)),
                    Op::Remove(id) => prop_assert_eq!(set.remove(id), model.remove(&id)),
                    Op::Contains(id) => {
                        prop_assert_eq!(set.contains(id), model.contains(&id));
                        prop_assert_eq!(set.first_from(id), model.range(id..).next().copied());
                    }
                    Op::Grow(capacity) => set.grow(capacity),
                    Op::Clear => {
                        set.clear();
                        model.clear();
                    }
                    Op::Union(ids) => {
                        let mut other = BitSet::new();
                        ids.iter().for_each(|id| { other.insert(*id); });
                        set.union_with(&other);
                        model.extend(ids);
                    }
                }
                if step % 100 == 0 {
                    prop_assert!(set.iter().eq(model.iter().copied()));
                    prop_assert_eq!(set.count(), model.len());
                    prop_assert_eq!(set.is_empty(), model.is_empty());
                    let blocks = (0..set.blocks(3)).flat_map(|block| set.iter_block(3, block));
                    prop_assert!(blocks.eq(model.iter().copied()));
                }
            }
        }
    }

    #[test]
    fn equality_is_of_members_not_of_storage() {
        let (mut a, mut b) = (BitSet::new(), BitSet::new());
        a.insert(3);
        b.insert(3);
        b.insert(900);
        assert_ne!(a, b);
        b.remove(900);
        assert_eq!(a, b);
        assert_eq!(b, a);
        assert!(!a.contains(u32::MAX) && !a.remove(u32::MAX));
    }
}
