//! Where each collider's box stands: the trees by what moves a collider, and its leaf in one of them.

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
    /// How many leaves of each tree grew since it was last rebuilt.
    grown: [usize; 4],
}

#[derive(Clone, Copy)]
struct Place {
    kind: TreeKind,
    leaf: Option<ProxyId>,
}

/// New leaves from this many on are entered at once.
const BULK: usize = 256;

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

    /// Gives the leaves of the colliders in `moved` their fat boxes, and rebuilds what grew much.
    pub(crate) fn update(&mut self, moved: &BitSet, fat: &[Aabb]) {
        let mut fresh: [Vec<(u32, Aabb)>; 4] = Default::default();
        for id in moved.iter() {
            let Some(Some(place)) = self.places.get(id as usize) else { continue };
            let aabb = fat[id as usize];
            match place.leaf {
                Some(leaf) => {
                    self.trees[place.kind].enlarge(leaf, aabb);
                    self.grown[place.kind as usize] += 1;
                }
                None => fresh[place.kind as usize].push((id, aabb)),
            }
        }
        for kind in TreeKind::ALL {
            self.enter(kind, &fresh[kind as usize]);
            let grown = &mut self.grown[kind as usize];
            if *grown * 16 > self.trees[kind].len() {
                *grown = 0;
                self.trees[kind].rebuild_partial();
            }
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
