//! The collider trees, one per kind of motion, and the leaf of each collider.

use super::optimization::TreeOptimizationMode;
use bevy_platform::time::Instant;
use core::time::Duration;
use kernel::{
    bvh::{Mover, Movers, PairMask, ProxyId, TreeKind, Trees},
    data::BitSet,
    shape::Aabb,
    thread_pool::ThreadPool,
};

/// The trees, and the leaf of each collider.
#[derive(Clone, Default)]
pub(crate) struct ProxyTable {
    pub(crate) trees: Trees,
    places: Vec<Option<Place>>,
    /// State of each tree.
    states: [TreeState; 4],
}

/// Changes of a tree since it was last optimized.
#[derive(Clone, Copy, Default)]
struct TreeState {
    /// Number of leaves that grew in place since the boxes above them were last fitted.
    grown: usize,
    /// Number of leaves that moved since the tree's cost was last computed.
    moved: usize,
    /// Cost after the last rebuild.
    rebuilt: f32,
}

#[derive(Clone, Copy)]
struct Place {
    kind: TreeKind,
    leaf: Option<ProxyId>,
}

/// Minimum number of new leaves that are inserted in one build. Fewer are inserted one by one.
const BULK: usize = 256;

/// A tree is optimized when one in this many leaves has grown. A larger number leaves loose boxes that find
/// more pairs; a smaller number refits more often.
const GROWN: usize = 16;

/// The whole tree is refitted when one in this many leaves has grown. With fewer grown leaves only the boxes
/// above them are refitted.
const MOST: usize = 3;

/// The cost of a tree is computed when one in this many leaves has moved.
const MOVED: usize = 4;

/// A tree is rebuilt when its cost has grown by this factor. A smaller factor rebuilds more often; a larger
/// one makes searches slower.
const WORSE: f32 = 1.25;

impl ProxyTable {
    /// Assigns a collider to a tree, and removes its leaf from any other.
    pub(crate) fn place(&mut self, id: u32, kind: TreeKind) {
        if self.kind(id) == Some(kind) {
            return;
        }
        self.remove(id);
        if self.places.len() <= id as usize {
            self.places.resize(id as usize + 1, None);
        }
        self.places[id as usize] = Some(Place { kind, leaf: None });
    }

    /// Removes a collider.
    pub(crate) fn remove(&mut self, id: u32) {
        if let Some(Place { kind, leaf: Some(leaf) }) =
            self.places.get_mut(id as usize).and_then(Option::take)
        {
            self.trees[kind].remove(leaf);
        }
    }

    /// The tree that a collider is assigned to.
    pub(crate) fn kind(&self, id: u32) -> Option<TreeKind> {
        self.places.get(id as usize).copied().flatten().map(|p| p.kind)
    }

    /// Whether a collider has no leaf yet.
    pub(crate) fn is_new(&self, id: u32) -> bool {
        self.places.get(id as usize).copied().flatten().is_some_and(|p| p.leaf.is_none())
    }

    /// Moves the leaves of the colliders in `moved` to their fat boxes, and optimizes the trees. The boxes in
    /// `fat` of all other colliders must be unchanged.
    ///
    /// Unless the mode is to reinsert, leaves grow in place until one in [`GROWN`] has grown: the work of
    /// refitting or rebuilding is then in proportion to the grown leaves. Returns the time for optimizing.
    pub(crate) fn update(
        &mut self,
        moved: &BitSet,
        fat: &[Aabb],
        mode: TreeOptimizationMode,
        pool: &ThreadPool,
    ) -> Duration {
        let mut fresh: [Vec<(u32, Aabb)>; 4] = Default::default();
        let mut grown = [0; 4];
        for id in moved.iter() {
            if let Some(Some(Place { kind, leaf: Some(_) })) = self.places.get(id as usize) {
                grown[*kind as usize] += 1;
            }
        }
        let share = |kind: TreeKind, part: usize| grown[kind as usize] * part > self.trees[kind].len();
        let reinsert = mode == TreeOptimizationMode::Reinsert;
        let [most, many] = [MOST, GROWN].map(|part| TreeKind::ALL.map(|k| !reinsert && share(k, part)));
        for id in moved.iter() {
            let Some(Some(place)) = self.places.get(id as usize) else { continue };
            let (aabb, kind) = (fat[id as usize], place.kind);
            let tree = &mut self.trees[kind];
            match place.leaf {
                None => fresh[kind as usize].push((id, aabb)),
                Some(_) if most[kind as usize] => {}
                Some(leaf) if reinsert => tree.set(leaf, aabb),
                Some(leaf) if many[kind as usize] => tree.place(leaf, aabb),
                Some(leaf) => tree.enlarge(leaf, aabb),
            }
        }
        let mut optimizing = Duration::ZERO;
        for kind in TreeKind::ALL {
            let i = kind as usize;
            if most[i] {
                self.trees[kind].fit(&|id| fat[id as usize], pool);
            } else if many[i] {
                self.trees[kind].refit();
            }
            if !reinsert {
                self.states[i].grown += grown[i];
            }
            self.enter(kind, &fresh[i]);
            let start = Instant::now();
            self.put_in_order(kind, mode, many[i]);
            optimizing += start.elapsed();
        }
        optimizing
    }

    /// Optimizes a tree if it is due. `fitted` says whether its boxes were just refitted.
    fn put_in_order(&mut self, kind: TreeKind, mode: TreeOptimizationMode, fitted: bool) {
        let (tree, state) = (&mut self.trees[kind], &mut self.states[kind as usize]);
        if state.grown * GROWN <= tree.len() {
            return;
        }
        let share = state.grown as f32 / tree.len() as f32;
        state.moved += core::mem::take(&mut state.grown);
        if let TreeOptimizationMode::Adaptive { .. } = mode {
            if !fitted {
                tree.refit();
            }
            if state.moved * MOVED <= tree.len() {
                return;
            }
            state.moved = 0;
            if tree.cost() <= WORSE * state.rebuilt {
                return;
            }
        }
        match mode.resolve(share) {
            TreeOptimizationMode::FullRebuild => tree.rebuild_full(),
            _ => _ = tree.rebuild_partial(),
        }
        state.rebuilt = tree.cost();
    }

    fn enter(&mut self, kind: TreeKind, leaves: &[(u32, Aabb)]) {
        let mut proxies = Vec::new();
        if leaves.len() >= BULK {
            self.trees[kind].insert_many(leaves, &mut proxies);
        } else {
            proxies.extend(leaves.iter().map(|(id, aabb)| self.trees[kind].insert(*id, *aabb)));
        }
        for ((id, _), leaf) in leaves.iter().zip(proxies) {
            self.places[*id as usize] = Some(Place { kind, leaf: Some(leaf) });
        }
    }

    /// The query for new pairs of a collider that moved. Static colliders form pairs with dynamic and
    /// kinematic ones. Pairs of two colliders without a body matter to sensors only, and are filtered later.
    pub(crate) fn mover(&self, id: u32, aabb: Aabb) -> Option<Mover> {
        let kind = self.kind(id)?;
        let dynamic = PairMask::only(TreeKind::Dynamic);
        let moving = dynamic.with(PairMask::only(TreeKind::Kinematic));
        let mask = match kind {
            TreeKind::Static => moving,
            TreeKind::Standalone => moving.with(PairMask::only(TreeKind::Standalone)),
            TreeKind::Kinematic | TreeKind::Dynamic => PairMask::ALL,
        };
        Some(Mover { id, kind, mask, aabb })
    }

    /// The queries of a set of colliders.
    pub(crate) fn movers(&self, moved: &BitSet, fat: &[Aabb], out: &mut Movers) {
        out.clear();
        for id in moved.iter() {
            if let Some(mover) = self.mover(id, fat[id as usize]) {
                out.insert(mover);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kernel::math::Vector;

    const KIND: TreeKind = TreeKind::Dynamic;

    /// How far the tree reaches beyond its leaves, after the last `moved` of a row of a hundred boxes moved
    /// to its middle.
    fn slack(moved: u32, mode: TreeOptimizationMode) -> f32 {
        let at = |x: u32| Aabb::new(Vector::X * x as f32, Vector::X * x as f32 + Vector::ONE);
        let mut fat: Vec<_> = (0..100).map(at).collect();
        let mut proxies = ProxyTable::default();
        (0..100).for_each(|id| proxies.place(id, KIND));
        let from = |first: u32| {
            let mut ids = BitSet::default();
            (first..100).for_each(|id| _ = ids.insert(id));
            ids
        };
        proxies.update(&from(0), &fat, mode, &ThreadPool::default());
        (100 - moved..100).for_each(|id| fat[id as usize] = at(20));
        proxies.update(&from(100 - moved), &fat, mode, &ThreadPool::default());
        proxies.trees[KIND].validate();
        proxies.trees[KIND].bounds().max.x - (100 - moved) as f32
    }

    #[test]
    fn trees_are_optimized_as_the_mode_says() {
        use TreeOptimizationMode::{FullRebuild, PartialRebuild, Reinsert};
        assert_eq!(slack(2, Reinsert), 0.0, "reinserted at once");
        for mode in [PartialRebuild, FullRebuild, TreeOptimizationMode::default()] {
            assert_eq!(slack(2, mode), 2.0, "few grow in place");
            assert_eq!(slack(50, mode), 0.0, "many are rebuilt");
        }
    }
}
