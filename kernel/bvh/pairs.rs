//! Which pairs of boxes came to touch: every mover asks the trees it may touch, or, where most moved, the trees are
//! walked at once.

use super::meet::{Slots, Walk};
use super::tree::Tree;
use crate::data::{BitSet, PairSet};
use crate::shape::Aabb;
use crate::team::Team;
use std::sync::{Mutex, PoisonError};

/// How many movers a member of the team asks for at a stretch.
const BLOCK: usize = 32;

/// Two trees are walked at once if one of so many leaves in them moved, and at least so many in all.
const MANY: (usize, usize) = (3, 64);

/// Into about how many parts such a walk is cut for each tree against another.
const PARTS: usize = 64;

/// Pairs found are held against those known when there are so many: what was prefetched is still there.
const TO_LOOK_UP: usize = 128;

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
    /// Places in the list by id; as above.
    places: Vec<u32>,
}

impl Movers {
    /// Adds a mover; whether its id was absent. If it was not, what is said now counts.
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

    /// Whether a collider is a mover that looks for partners of a kind.
    #[inline(always)]
    fn asks(&self, id: u32, kind: TreeKind) -> bool {
        self.moved.contains(id) && self.masks[id as usize].contains(kind)
    }

    /// Whether the pair of a mover and what it found is left to the other, who finds it as well.
    #[inline(always)]
    fn is_left_to(&self, found: u32, mover: &Mover) -> bool {
        found < mover.id && self.asks(found, mover.kind)
    }
}

/// Which pairs are of no interest.
pub trait Known: Sync {
    /// Whether it is plain to see that a pair, lower id first, is none: asked for every two boxes that touch and of which
    /// one moved.
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

/// What the movers of a step are searched by: kinds between which most leaves moved by walking both trees at once,
/// the others by a query for each mover.
#[derive(Debug, Default)]
struct Plan {
    /// For each kind those it is queried against.
    queried: [PairMask; 4],
    /// Parts of walks, and between which kinds.
    parts: Vec<([TreeKind; 2], Slots)>,
    /// Room to divide a walk in.
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

    /// How many blocks of movers there are to query for.
    fn query_blocks(&self, movers: &Movers) -> usize {
        if self.queried == [PairMask::NONE; 4] { 0 } else { movers.list().len().div_ceil(BLOCK) }
    }
}

/// What a member of the team needs: the pairs it found, and room. In cache lines of its own, for it is written with
/// every step of a walk.
#[derive(Debug, Default)]
#[repr(align(128))]
struct Member {
    found: Vec<(u32, u32)>,
    walk: Walk,
}

impl Member {
    /// Adds the pairs `(lower id, higher id)` that one mover is to report: what its box touches in the trees of the
    /// `kinds` its mask names, less itself, less the pairs of two movers that the lower one reports, less those that
    /// are [plain](Known::is_plain). Order as the trees have it.
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

    /// Adds the pairs of one part of a walk, less those neither of whom moved and asks for the other, less those that
    /// are plain or known.
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
                if found.len() - start == TO_LOOK_UP {
                    drop_known(found, start, known);
                    start = found.len();
                }
            }
        });
        drop_known(found, start, known);
    }
}

/// Takes the pairs from `start` on out that are known.
fn drop_known(found: &mut Vec<(u32, u32)>, start: usize, known: &impl Known) {
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
    plan: Plan,
    members: Vec<Mutex<Member>>,
}

impl FoundPairs {
    /// Finds the pairs of all movers anew: sorted, each once. Every id must stand in one tree only, once.
    pub fn find(&mut self, trees: &Trees, movers: &Movers, known: &impl Known, team: &Team) {
        if self.members.len() < team.members() {
            self.members.resize_with(team.members(), Mutex::default);
        }
        let Self { sorted, plan, members } = self;
        plan.make(trees, movers);
        let (plan, list, parts) = (&*plan, movers.list(), plan.parts.len());
        team.run(parts + plan.query_blocks(movers), |block, member| {
            let mut member = members[member].lock().unwrap_or_else(PoisonError::into_inner);
            let Some(block) = block.checked_sub(parts) else {
                return member.walk(plan.parts[block], trees, movers, known);
            };
            let start = member.found.len();
            for mover in &list[block * BLOCK..list.len().min((block + 1) * BLOCK)] {
                member.query(mover, plan.queried[mover.kind as usize], trees, movers, known);
            }
            // First all are asked for, then looked at: the memory's answers need not be waited for one by one.
            member.found[start..].iter().for_each(|(a, b)| known.prefetch(*a, *b));
            drop_known(&mut member.found, start, known);
        });
        sorted.clear();
        for member in members {
            sorted.append(&mut member.get_mut().unwrap_or_else(PoisonError::into_inner).found);
        }
        sorted.sort_unstable();
    }

    /// The pairs found last, `(lower id, higher id)`, sorted.
    pub fn pairs(&self) -> &[(u32, u32)] {
        &self.sorted
    }
}
