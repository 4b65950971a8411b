//! Pairs of boxes that began to touch. They are found by a query of the trees for every mover, or, if most
//! leaves moved, by walking two trees at once.

use super::meet::{Slots, Walk};
use super::tree::Tree;
use crate::data::{BitSet, PairSet, Slack};
use crate::shape::Aabb;
use crate::thread_pool::ThreadPool;
use std::sync::{Mutex, PoisonError};

/// The number of movers in a block. Smaller blocks cost more to hand out, larger ones balance worse.
const BLOCK: usize = 32;

/// Two trees are walked at once if at least one in `MANY.0` of their leaves moved, and at least `MANY.1`
/// leaves in all. A walk also visits leaves that did not move; queries go down from the root for each mover.
const MANY: (usize, usize) = (3, 64);

/// The approximate number of parts of a walk of two trees, which workers share. Fewer parts balance worse.
const PARTS: usize = 64;

/// The number of found pairs that are compared with the known pairs at once. Their prefetched slots are still
/// in the cache.
const LOOK_UP_BATCH: usize = 128;

/// The kinds of colliders, by the kind of their body. Each kind has its own tree.
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

/// A set of kinds that a mover may form pairs with.
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

    /// The kinds in either set.
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether the kind is in the set.
    #[inline]
    pub const fn contains(self, kind: TreeKind) -> bool {
        self.0 >> kind as u8 & 1 != 0
    }

    /// The kinds that solid colliders of a kind can touch: dynamic colliders touch every kind, all others
    /// only dynamic ones. Sensors and colliders with events need more.
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
    /// The collider: the id that its leaf was inserted with.
    pub id: u32,
    /// The tree of its leaf.
    pub kind: TreeKind,
    /// The kinds that it may form pairs with.
    pub mask: PairMask,
    /// Its box, as in the tree.
    pub aabb: Aabb,
}

/// The movers of a step, each once.
#[derive(Clone, Debug, Default)]
pub struct Movers {
    list: Vec<Mover>,
    moved: BitSet,
    /// By id. Valid only for ids in `moved`.
    masks: Vec<PairMask>,
    /// Indices in the list, by id. Valid only for ids in `moved`.
    places: Vec<u32>,
}

impl Movers {
    /// Adds a mover, or replaces the mover with the same id. Returns whether the id was absent.
    pub fn insert(&mut self, mover: Mover) -> bool {
        let absent = self.moved.insert(mover.id);
        let i = mover.id as usize;
        if i >= self.masks.len() {
            self.masks.resize(i + 1, PairMask::NONE);
            self.places.resize(i + 1, 0);
        }
        self.masks[i] = mover.mask;
        if absent {
            self.places[i] = self.list.len() as u32;
            self.list.push(mover);
        } else {
            self.list[self.places[i] as usize] = mover;
        }
        absent
    }

    /// The movers in the order of insertion. Blocks of the list may be searched in parallel.
    #[inline]
    pub fn list(&self) -> &[Mover] {
        &self.list
    }

    /// Whether the collider is a mover.
    #[inline]
    pub fn contains(&self, id: u32) -> bool {
        self.moved.contains(id)
    }

    /// Removes all movers and keeps the storage.
    pub fn clear(&mut self) {
        for mover in &self.list {
            self.moved.remove(mover.id);
        }
        self.list.clear();
    }

    /// Whether a collider is a mover that may form pairs with a kind.
    #[inline(always)]
    fn asks(&self, id: u32, kind: TreeKind) -> bool {
        self.moved.contains(id) && self.masks[id as usize].contains(kind)
    }

    /// Whether the other collider of a pair is a mover that finds the pair as well, and reports it.
    #[inline(always)]
    fn is_left_to(&self, found: u32, mover: &Mover) -> bool {
        found < mover.id && self.asks(found, mover.kind)
    }
}

/// The pairs that must not be reported.
pub trait Known: Sync {
    /// A cheap test whether a pair, lower id first, must not be reported. Called for every pair of touching
    /// boxes if at least one box moved.
    fn is_plain(&self, a: u32, b: u32) -> bool;
    /// Prefetches the memory that [`contains`](Self::contains) reads.
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

/// How pairs of each two kinds are searched: by walking both trees at once if most leaves moved, otherwise by
/// a query for each mover.
#[derive(Debug, Default)]
struct Plan {
    /// The kinds that are queried for movers of each kind.
    queried: [PairMask; 4],
    /// Parts of walks, each with its two kinds.
    parts: Vec<([TreeKind; 2], Slots)>,
    /// Buffer for dividing walks.
    walk: Walk,
    divided: Vec<Slots>,
}

impl Plan {
    fn make(&mut self, trees: &Trees, movers: &Movers) {
        self.parts.clear();
        let mut asked = [[0; 4]; 4];
        for mover in movers.list() {
            for kind in TreeKind::ALL {
                asked[mover.kind as usize][kind as usize] += usize::from(mover.mask.contains(kind));
            }
        }
        self.queried = [PairMask::NONE; 4];
        for a in TreeKind::ALL {
            for b in TreeKind::ALL.into_iter().filter(|b| *b >= a) {
                let there = |x: TreeKind, y: TreeKind| asked[x as usize][y as usize];
                let (asked, leaves) = if a == b {
                    (there(a, a), trees[a].len())
                } else {
                    (there(a, b) + there(b, a), trees[a].len() + trees[b].len())
                };
                if asked == 0 {
                    continue;
                }
                if asked < MANY.1 || asked * MANY.0 < leaves {
                    for (x, y) in [(a, b), (b, a)] {
                        self.queried[x as usize] = self.queried[x as usize].with(PairMask::only(y));
                    }
                    continue;
                }
                let other = (a != b).then_some(&trees[b]);
                self.walk.divide(&trees[a], other, PARTS, &mut self.divided);
                self.parts.extend(self.divided.iter().map(|part| ([a, b], *part)));
            }
        }
    }

    /// The number of blocks of movers.
    fn query_blocks(&self, movers: &Movers) -> usize {
        if self.queried == [PairMask::NONE; 4] { 0 } else { movers.list().len().div_ceil(BLOCK) }
    }
}

/// The pairs that a worker found, and its buffers. They have cache lines of their own, since walks write them
/// all the time.
#[derive(Debug, Default)]
#[repr(align(128))]
struct Worker {
    found: Vec<(u32, u32)>,
    walk: Walk,
}

impl Worker {
    /// Adds the pairs `(lower id, higher id)` that one mover reports, in the order of the trees: colliders
    /// whose boxes it touches in the trees of its `kinds`. Skips the mover itself, pairs that the other mover
    /// reports, and [plain](Known::is_plain) pairs.
    #[inline]
    fn query(&mut self, mover: &Mover, kinds: PairMask, trees: &Trees, movers: &Movers, known: &impl Known) {
        for kind in TreeKind::ALL.into_iter().filter(|k| mover.mask.contains(*k) && kinds.contains(*k)) {
            trees[kind].query(&mover.aabb, |found| {
                let pair = (found.min(mover.id), found.max(mover.id));
                if found != mover.id && !movers.is_left_to(found, mover) && !known.is_plain(pair.0, pair.1) {
                    self.found.push(pair);
                }
                true
            });
        }
    }

    /// Adds the pairs of one part of a walk. Skips plain and known pairs, and pairs without a mover that may
    /// form them.
    fn walk(
        &mut self,
        ([a, b], part): ([TreeKind; 2], Slots),
        trees: &Trees,
        movers: &Movers,
        known: &impl Known,
    ) {
        let Self { found, walk, .. } = self;
        let mut start = found.len();
        walk.meet(&trees[a], (a != b).then_some(&trees[b]), part, |x, y| {
            let pair = (x.min(y), x.max(y));
            if (movers.asks(x, b) || movers.asks(y, a)) && !known.is_plain(pair.0, pair.1) {
                known.prefetch(pair.0, pair.1);
                found.push(pair);
                if found.len() - start == LOOK_UP_BATCH {
                    drop_known(found, start, known);
                    start = found.len();
                }
            }
        });
        drop_known(found, start, known);
    }
}

/// Removes known pairs, from `start` on.
fn drop_known(found: &mut Vec<(u32, u32)>, start: usize, known: &impl Known) {
    let mut kept = start;
    for i in start..found.len() {
        let (a, b) = found[i];
        found[kept] = (a, b);
        kept += usize::from(!known.contains(a, b));
    }
    found.truncate(kept);
}

/// The pairs of movers that were found last, and the buffers to find them.
#[derive(Debug, Default)]
pub struct FoundPairs {
    sorted: Vec<(u32, u32)>,
    plan: Plan,
    workers: Vec<Mutex<Worker>>,
    slack: Slack,
}

impl FoundPairs {
    /// Finds the pairs of all movers, sorted, each once. Every id must be in exactly one tree, once.
    pub fn find(&mut self, trees: &Trees, movers: &Movers, known: &impl Known, pool: &ThreadPool) {
        if self.workers.len() < pool.workers() {
            self.workers.resize_with(pool.workers(), Mutex::default);
        }
        let Self { sorted, plan, workers, slack } = self;
        plan.make(trees, movers);
        let (plan, list, parts) = (&*plan, movers.list(), plan.parts.len());
        pool.run(parts + plan.query_blocks(movers), |block, worker| {
            let mut worker = workers[worker].lock().unwrap_or_else(PoisonError::into_inner);
            let Some(block) = block.checked_sub(parts) else {
                return worker.walk(plan.parts[block], trees, movers, known);
            };
            let start = worker.found.len();
            for mover in &list[block * BLOCK..list.len().min((block + 1) * BLOCK)] {
                worker.query(mover, plan.queried[mover.kind as usize], trees, movers, known);
            }
            // All slots are prefetched before any is read, so the loads overlap.
            worker.found[start..].iter().for_each(|(a, b)| known.prefetch(*a, *b));
            drop_known(&mut worker.found, start, known);
        });
        sorted.clear();
        for worker in &mut *workers {
            sorted.append(&mut worker.get_mut().unwrap_or_else(PoisonError::into_inner).found);
        }
        sorted.sort_unstable();
        if slack.is_due(sorted.len()) {
            sorted.shrink_to_fit();
            workers.clear();
        }
    }

    /// Keeps the pairs for which `keep` returns true. It is called with the index of each pair and the pair.
    pub fn retain(&mut self, mut keep: impl FnMut(u32, (u32, u32)) -> bool) {
        let mut place = 0;
        self.sorted.retain(|pair| {
            place += 1;
            keep(place - 1, *pair)
        });
    }

    /// Forgets the pairs found last.
    pub fn clear(&mut self) {
        self.sorted.clear();
    }

    /// The pairs found last, `(lower id, higher id)`, sorted.
    pub fn pairs(&self) -> &[(u32, u32)] {
        &self.sorted
    }
}
