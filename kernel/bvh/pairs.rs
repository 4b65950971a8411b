//! Which pairs of boxes came to touch: every mover asks the trees it may touch.

use super::tree::Tree;
use crate::data::{BitSet, PairSet};
use crate::shape::Aabb;
use crate::team::Team;
use std::sync::{Mutex, PoisonError};

/// How many movers a member of the team asks for at a stretch.
const BLOCK: usize = 32;

/// What moves a collider decides in which tree it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TreeKind {
    /// On a static body.
    Static,
    /// On a kinematic body.
    Kinematic,
    /// On a dynamic body.
    Dynamic,
    /// Without a body.
    Standalone,
}

impl TreeKind {
    /// All kinds, in order.
    pub const ALL: [Self; 4] = [Self::Static, Self::Kinematic, Self::Dynamic, Self::Standalone];
}

/// A set of kinds: those a mover may form pairs with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PairMask(u8);

impl PairMask {
    /// No kind.
    pub const NONE: Self = Self(0);
    /// Every kind.
    pub const ALL: Self = Self(0b1111);

    /// Just one kind.
    pub const fn only(kind: TreeKind) -> Self {
        Self(1 << kind as u8)
    }

    /// The kinds of either set.
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether the kind is in the set.
    #[inline]
    pub const fn contains(self, kind: TreeKind) -> bool {
        self.0 >> kind as u8 & 1 != 0
    }

    /// The kinds that solid colliders of a kind can push or be pushed by: dynamic ones touch
    /// everything, all others only what is dynamic. Sensors and event collectors ask for more.
    pub const fn solid(kind: TreeKind) -> Self {
        match kind {
            TreeKind::Dynamic => Self::ALL,
            _ => Self::only(TreeKind::Dynamic),
        }
    }
}

/// A tree per kind of collider.
#[derive(Clone, Debug, Default)]
pub struct Trees {
    /// The trees, in the order of [`TreeKind`].
    pub trees: [Tree; 4],
}

impl core::ops::Index<TreeKind> for Trees {
    type Output = Tree;
    #[inline]
    fn index(&self, kind: TreeKind) -> &Tree {
        &self.trees[kind as usize]
    }
}

impl core::ops::IndexMut<TreeKind> for Trees {
    #[inline]
    fn index_mut(&mut self, kind: TreeKind) -> &mut Tree {
        &mut self.trees[kind as usize]
    }
}

/// A collider whose box in its tree is new or changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mover {
    /// The collider: the id its leaf was inserted with.
    pub id: u32,
    /// The tree its leaf stands in.
    pub kind: TreeKind,
    /// The kinds to look for partners among.
    pub mask: PairMask,
    /// Its box, as in the tree.
    pub aabb: Aabb,
}

/// The movers of a step, each once.
#[derive(Clone, Debug, Default)]
pub struct Movers {
    list: Vec<Mover>,
    moved: BitSet,
    /// By id; of use only where `moved` has it.
    masks: Vec<PairMask>,
}

impl Movers {
    /// Adds a mover; whether its id was absent. If it was not, nothing changes.
    pub fn insert(&mut self, mover: Mover) -> bool {
        let absent = self.moved.insert(mover.id);
        if absent {
            let i = mover.id as usize;
            if i >= self.masks.len() {
                self.masks.resize(i + 1, PairMask::NONE);
            }
            self.masks[i] = mover.mask;
            self.list.push(mover);
        }
        absent
    }

    /// The movers in the order of insertion: blocks of it may be searched in parallel.
    #[inline]
    pub fn list(&self) -> &[Mover] {
        &self.list
    }

    /// Whether the collider is a mover.
    #[inline]
    pub fn contains(&self, id: u32) -> bool {
        self.moved.contains(id)
    }

    /// Takes all out; the storage stays.
    pub fn clear(&mut self) {
        for mover in &self.list {
            self.moved.remove(mover.id);
        }
        self.list.clear();
    }

    /// Whether the pair of a mover and what it found is left to the other, who finds it as well.
    #[inline(always)]
    fn is_left_to(&self, found: u32, mover: &Mover) -> bool {
        found < mover.id && self.moved.contains(found) && self.masks[found as usize].contains(mover.kind)
    }
}

/// Which pairs are of no interest.
pub trait Known: Sync {
    /// Whether it is plain to see that a pair, lower id first, is none: asked for every two boxes that touch.
    fn is_plain(&self, a: u32, b: u32) -> bool;
    /// Has the memory brought near that [`contains`](Self::contains) looks at.
    fn prefetch(&self, a: u32, b: u32);
    /// Whether the pair is known.
    fn contains(&self, a: u32, b: u32) -> bool;
}

impl Known for PairSet {
    #[inline]
    fn is_plain(&self, _: u32, _: u32) -> bool {
        false
    }

    #[inline]
    fn prefetch(&self, a: u32, b: u32) {
        Self::prefetch(self, a, b);
    }

    #[inline]
    fn contains(&self, a: u32, b: u32) -> bool {
        Self::contains(self, a, b)
    }
}

/// Appends the pairs `(lower id, higher id)` that one mover is to report: what its box touches in the trees
/// its mask names, less itself, less the pairs of two movers that the lower one reports, less those that are
/// [plain](Known::is_plain). Order as the trees have it.
#[inline]
fn pairs_of(mover: &Mover, trees: &Trees, movers: &Movers, known: &impl Known, out: &mut Vec<(u32, u32)>) {
    for kind in TreeKind::ALL.into_iter().filter(|k| mover.mask.contains(*k)) {
        trees[kind].query(&mover.aabb, |found| {
            let pair = (found.min(mover.id), found.max(mover.id));
            if found != mover.id && !movers.is_left_to(found, mover) && !known.is_plain(pair.0, pair.1) {
                out.push(pair);
            }
            true
        });
    }
}

/// Takes the pairs from `start` on out that are known: first all are asked for, then looked at, so that the
/// memory's answers need not be waited for one by one.
fn drop_known(found: &mut Vec<(u32, u32)>, start: usize, known: &impl Known) {
    found[start..].iter().for_each(|(a, b)| known.prefetch(*a, *b));
    let mut kept = start;
    for i in start..found.len() {
        let (a, b) = found[i];
        found[kept] = (a, b);
        kept += usize::from(!known.contains(a, b));
    }
    found.truncate(kept);
}

/// The pairs that movers came into, and the memory to find them with.
#[derive(Debug, Default)]
pub struct FoundPairs {
    sorted: Vec<(u32, u32)>,
    /// What each member of the team found.
    by_member: Vec<Mutex<Vec<(u32, u32)>>>,
}

impl FoundPairs {
    /// Finds the pairs of all movers anew: sorted, each once. Every id must stand in one tree only, once.
    pub fn find(&mut self, trees: &Trees, movers: &Movers, known: &impl Known, team: &Team) {
        if self.by_member.len() < team.members() {
            self.by_member.resize_with(team.members(), Mutex::default);
        }
        let (list, by_member) = (movers.list(), &self.by_member);
        team.run(list.len().div_ceil(BLOCK), |block, member| {
            let mut found = by_member[member].lock().unwrap_or_else(PoisonError::into_inner);
            let start = found.len();
            for mover in &list[block * BLOCK..list.len().min((block + 1) * BLOCK)] {
                pairs_of(mover, trees, movers, known, &mut found);
            }
            drop_known(&mut found, start, known);
        });
        self.sorted.clear();
        for found in &mut self.by_member {
            self.sorted.append(found.get_mut().unwrap_or_else(PoisonError::into_inner));
        }
        self.sorted.sort_unstable();
    }

    /// The pairs found last, `(lower id, higher id)`, sorted.
    pub fn pairs(&self) -> &[(u32, u32)] {
        &self.sorted
    }
}
