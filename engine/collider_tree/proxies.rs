//! Where each collider's box stands: the trees by what moves a collider, and its leaf in one of them.

use super::optimization::TreeOptimizationMode;
use kernel::{
    bvh::{Mover, Movers, PairMask, ProxyId, TreeKind, Trees},
    data::BitSet,
    shape::Aabb,
};

/// The trees and each collider's leaf.
#[derive(Clone, Default)]
pub(crate) struct ProxyTable {
    pub(crate) trees: Trees,
    places: Vec<Option<Place>>,
    /// How many leaves of each tree grew in place since it was last rebuilt.
    grown: [usize; 4],
}

#[derive(Clone, Copy)]
struct Place {
    kind: TreeKind,
    leaf: Option<ProxyId>,
}

/// New leaves from this many on are entered at once.
const BULK: usize = 256;

/// A tree is rebuilt when one of so many leaves has grown.
const REBUILD: usize = 16;

impl ProxyTable {
    /// Says in which tree a collider belongs; its leaf leaves any other.
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

    /// Takes a collider out.
    pub(crate) fn remove(&mut self, id: u32) {
        if let Some(Place { kind, leaf: Some(leaf) }) =
            self.places.get_mut(id as usize).and_then(Option::take)
        {
            self.trees[kind].remove(leaf);
        }
    }

    /// The tree a collider belongs in.
    pub(crate) fn kind(&self, id: u32) -> Option<TreeKind> {
        self.places.get(id as usize).copied().flatten().map(|p| p.kind)
    }

    /// Whether a collider has no leaf yet.
    pub(crate) fn is_new(&self, id: u32) -> bool {
        self.places.get(id as usize).copied().flatten().is_some_and(|p| p.leaf.is_none())
    }

    /// Gives the leaves of the colliders in `moved` their fat boxes, and keeps the trees good to search.
    ///
    /// Unless the app wants every leaf reinserted, leaves grow in place until one in [`REBUILD`] has: rebuilding
    /// above them then costs as much as what grew.
    pub(crate) fn update(&mut self, moved: &BitSet, fat: &[Aabb], mode: TreeOptimizationMode) {
        let mut fresh: [Vec<(u32, Aabb)>; 4] = Default::default();
        for id in moved.iter() {
            let Some(Some(place)) = self.places.get(id as usize) else { continue };
            let aabb = fat[id as usize];
            match place.leaf {
                Some(leaf) if mode == TreeOptimizationMode::Reinsert => {
                    self.trees[place.kind].set(leaf, aabb);
                }
                Some(leaf) => {
                    self.trees[place.kind].enlarge(leaf, aabb);
                    self.grown[place.kind as usize] += 1;
                }
                None => fresh[place.kind as usize].push((id, aabb)),
            }
        }
        for kind in TreeKind::ALL {
            self.enter(kind, &fresh[kind as usize]);
            let (tree, grown) = (&mut self.trees[kind], &mut self.grown[kind as usize]);
            if *grown * REBUILD <= tree.len() {
                continue;
            }
            match mode.resolve(*grown as f32 / tree.len() as f32) {
                TreeOptimizationMode::FullRebuild => tree.rebuild_full(),
                _ => _ = tree.rebuild_partial(),
            }
            *grown = 0;
        }
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

    /// What a collider that moved may have come to touch. Pairs in which neither side can be pushed are of
    /// use to sensors only, and sorted out later.
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

    /// The movers of a set of colliders.
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

    /// How much too far the tree reaches after the last `moved` of a row of a hundred boxes went into its middle.
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
        proxies.update(&from(0), &fat, mode);
        (100 - moved..100).for_each(|id| fat[id as usize] = at(20));
        proxies.update(&from(100 - moved), &fat, mode);
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
