//! Disjoint sets over `0..n`.

/// Union-find with union by rank and path halving (Tarjan and van Leeuwen, "Worst-case analysis of set union
/// algorithms", 1984): almost constant time per call, no recursion. Buffers are reused.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct DisjointSets {
    parent: Vec<u32>,
    /// Upper bound of the height of the tree below a root.
    rank: Vec<u8>,
    count: usize,
}

impl DisjointSets {
    /// Resets to `n` sets of one element each.
    pub(crate) fn reset(&mut self, n: usize) {
        self.parent.clear();
        self.parent.extend(0..n as u32);
        self.rank.clear();
        self.rank.resize(n, 0);
        self.count = n;
    }

    /// The number of disjoint sets.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The representative of an element's set.
    pub(crate) fn find(&mut self, element: u32) -> u32 {
        let mut at = element;
        loop {
            let parent = self.parent[at as usize];
            if parent == at {
                return at;
            }
            let grandparent = self.parent[parent as usize];
            self.parent[at as usize] = grandparent;
            at = grandparent;
        }
    }

    /// Merges the sets of `a` and `b`.
    pub(crate) fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        if a == b {
            return;
        }
        let (rank_a, rank_b) = (self.rank[a as usize], self.rank[b as usize]);
        let (root, child) = if rank_a >= rank_b { (a, b) } else { (b, a) };
        self.parent[child as usize] = root;
        if rank_a == rank_b {
            self.rank[root as usize] += 1;
        }
        self.count -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The sets are the classes of the finest equivalence that contains the pairs, by brute force.
        #[test]
        fn sets_are_connected_components(
            n in 1u32..60,
            pairs in prop::collection::vec((any::<u32>(), any::<u32>()), 0..80),
        ) {
            let mut sets = DisjointSets::default();
            sets.reset(7);
            sets.reset(n as usize);
            let mut label: Vec<u32> = (0..n).collect();
            for (a, b) in pairs {
                let (a, b) = (a % n, b % n);
                sets.unite(a, b);
                let (from, to) = (label[a as usize], label[b as usize]);
                label.iter_mut().filter(|l| **l == from).for_each(|l| *l = to);
            }
            for a in 0..n {
                for b in 0..n {
                    prop_assert_eq!(sets.find(a) == sets.find(b), label[a as usize] == label[b as usize]);
                }
            }
            label.sort_unstable();
            label.dedup();
            prop_assert_eq!(sets.count(), label.len());
        }
    }
}
