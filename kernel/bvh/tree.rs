//! The tree: its layout, and changes of one leaf at a time.

use crate::math::DIM;
use crate::shape::Aabb;

/// A dynamic tree of boxes. Each leaf stores a `u32` of the user.
///
/// *Layout.* A `Branch` holds the boxes of *both* children in one cache line, and a leaf's box is in its
/// parent. So a walk reads one line per branch that was hit, and none for nodes that were missed. A leaf
/// takes 72 bytes. (Transposing the bounds for four-lane tests made rays some 15 % faster, and box queries,
/// which wait for mispredicted jumps, no faster.) Leaves keep their number (the [`ProxyId`]) when branches
/// move, so a full rebuild can sort the branches in the order of a walk.
///
/// *Which change to use when:*
///
/// - [`set`](Self::set) moves a leaf to another place in the tree. Its cost is removing and inserting the
///   leaf. Use it for a leaf that moved far.
/// - [`enlarge`](Self::enlarge) changes the box of a leaf and grows the boxes above. Its cost is at most the
///   path to the root. Use it for a few small motions; queries stay correct.
/// - [`place`](Self::place) changes only the box of a leaf, at the least cost. Use it for many small motions,
///   followed by `refit` or `fit` before any query.
/// - [`refit`](Self::refit) recomputes the boxes above changed leaves, which may shrink. Its cost is the
///   changed part of the tree. Use it after `place` or `enlarge`, on one thread.
/// - [`fit`](Self::fit) sets all leaves' boxes by a function of their ids, and all boxes above. Its cost is
///   the whole tree, shared by workers. Use it if a third of the leaves moved.
/// - [`rebuild_partial`](Self::rebuild_partial) rebuilds the branches above changed leaves. Its cost is the
///   changed part of the tree. Use it when [`cost`](Self::cost) has grown.
/// - [`rebuild_full`](Self::rebuild_full) rebuilds all branches. Its cost is sorting the whole tree. Use it
///   when the tree's cost has grown much.
///
/// *Invalid input.* A box that is not `min ≤ max` in every component (inverted, NaN) is stored as
/// [`Aabb::EMPTY`]: the leaf stays, and no query finds it. Infinite boxes are found by every query that
/// touches them. A stale proxy is a bug of the caller: it panics in debug builds and is ignored in release
/// builds.
///
/// *Determinism.* The shape of the tree depends only on the calls made, in order.
#[derive(Clone, Debug)]
pub struct Tree {
    pub(super) branches: Vec<Branch>,
    pub(super) leaves: Vec<Leaf>,
    /// The top node, [`NONE`] if the tree is empty, and its box.
    pub(super) root: u32,
    pub(super) root_box: Aabb,
    pub(super) free_branch: u32,
    pub(super) free_leaf: u32,
    pub(super) len: u32,
    /// Buffers of the builders, empty between calls.
    pub(super) items: Vec<Item>,
    pub(super) order: Vec<u32>,
}

/// The number of a leaf, from its insertion to its removal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProxyId(pub u32);

/// An inner node: one cache line, with the boxes of both children.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Branch {
    pub boxes: [Aabb; 2],
    /// Two nodes: branch numbers, or leaf numbers with [`LEAF`] set.
    pub children: [u32; 2],
    /// The slot of this branch, or the next free branch if this one is free.
    pub parent: u32,
    /// 1 above leaves; 0 if the branch is free.
    pub height: u16,
    /// Bit `i` is set if a leaf below child `i` was inserted or enlarged since the last rebuild.
    pub enlarged: u16,
}

const _: () = assert!(size_of::<Branch>() == 64);

/// A user's id and the slot that holds the leaf's box: twice the branch's number plus the side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    pub id: u32,
    pub slot: u32,
}

/// Marks a node as a leaf, and the slot of a free leaf.
pub(super) const LEAF: u32 = 1 << 31;
/// The slot above everything.
pub(super) const ROOT: u32 = u32::MAX;
/// No node; ends the free lists.
pub(super) const NONE: u32 = u32::MAX;
/// Ends the free list of leaves. Also differs from [`ROOT`] when [`LEAF`] is set.
pub(super) const NO_LEAF: u32 = LEAF - 2;
/// Children whose heights differ by more are rotated even if that costs area. Smaller values make worse
/// trees; the bound only limits the depth of walks.
const MAX_IMBALANCE: u16 = 12;
/// A tree that grew higher is rebuilt, since walks have a stack of fixed size.
pub(super) const MAX_HEIGHT: u16 = 72;

pub(super) const FREE_BRANCH: Branch =
    Branch { boxes: [Aabb::EMPTY; 2], children: [NONE; 2], parent: NONE, height: 0, enlarged: 0 };

/// The content of a slot with its box.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    pub aabb: Aabb,
    pub node: u32,
    pub enlarged: bool,
}

/// An item of a build: a leaf, or a subtree that stays as it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub aabb: Aabb,
    pub node: u32,
}

impl Default for Tree {
    fn default() -> Self {
        Self::new()
    }
}

/// The box as the tree stores it; see [`Tree`] on invalid input.
#[inline(always)]
pub(super) fn admitted(aabb: Aabb) -> Aabb {
    let (low, high) = (aabb.min.to_array(), aabb.max.to_array());
    if (0..DIM).fold(true, |all, i| all & (low[i] <= high[i])) { aabb } else { Aabb::EMPTY }
}

impl Tree {
    /// The bytes that the tree keeps per leaf.
    pub const BYTES_PER_LEAF: usize = size_of::<Branch>() + size_of::<Leaf>();

    /// An empty tree without storage.
    pub const fn new() -> Self {
        Self {
            branches: Vec::new(),
            leaves: Vec::new(),
            root: NONE,
            root_box: Aabb::EMPTY,
            free_branch: NONE,
            free_leaf: NO_LEAF,
            len: 0,
            items: Vec::new(),
            order: Vec::new(),
        }
    }

    /// The number of leaves.
    #[inline]
    pub fn len(&self) -> usize {
        self.len as usize
    }

    /// Whether there is no leaf.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The maximum number of branches above a leaf: 0 for a tree with at most one leaf.
    pub fn height(&self) -> usize {
        usize::from(self.node_height(self.root))
    }

    /// A box around all leaves, [`Aabb::EMPTY`] if there are none. May be larger than needed after
    /// [`enlarge`](Self::enlarge).
    pub fn bounds(&self) -> Aabb {
        self.root_box
    }

    /// Whether the proxy names a leaf of this tree.
    pub fn is_live(&self, proxy: ProxyId) -> bool {
        self.leaves.get(proxy.0 as usize).is_some_and(|l| l.slot == ROOT || l.slot & LEAF == 0)
    }

    /// The box of a leaf as it was last set; [`Aabb::EMPTY`] for a stale proxy.
    #[inline]
    pub fn aabb(&self, proxy: ProxyId) -> Aabb {
        if self.is_checked(proxy) { self.slot_box(self.leaves[proxy.0 as usize].slot) } else { Aabb::EMPTY }
    }

    /// The user's id of a leaf; `u32::MAX` for a stale proxy.
    #[inline]
    pub fn id(&self, proxy: ProxyId) -> u32 {
        if self.is_checked(proxy) { self.leaves[proxy.0 as usize].id } else { u32::MAX }
    }

    /// Removes all leaves and keeps the storage.
    pub fn clear(&mut self) {
        self.branches.clear();
        self.leaves.clear();
        (self.root, self.root_box, self.len) = (NONE, Aabb::EMPTY, 0);
        (self.free_branch, self.free_leaf) = (NONE, NO_LEAF);
    }

    /// Adds a leaf at the place where the tree's boxes grow least.
    pub fn insert(&mut self, id: u32, aabb: Aabb) -> ProxyId {
        let leaf = self.new_leaf(id);
        self.attach(leaf, admitted(aabb));
        ProxyId(leaf)
    }

    /// Removes a leaf. Its proxy may be returned by a later [`insert`](Self::insert).
    pub fn remove(&mut self, proxy: ProxyId) {
        if self.is_checked(proxy) {
            self.detach(proxy.0);
            self.leaves[proxy.0 as usize] = Leaf { id: u32::MAX, slot: LEAF | self.free_leaf };
            self.free_leaf = proxy.0;
            self.len -= 1;
            if self.len == 0 {
                // The next leaves are then numbered as in a new tree.
                self.clear();
            }
        }
    }

    /// Moves a leaf as by removing and inserting it, but keeps the proxy.
    pub fn set(&mut self, proxy: ProxyId, aabb: Aabb) {
        if self.is_checked(proxy) {
            self.detach(proxy.0);
            self.attach(proxy.0, admitted(aabb));
        }
    }

    /// Changes the box of a leaf in place; the boxes above it only grow. It is for small motions, followed by
    /// [`rebuild_partial`](Self::rebuild_partial).
    pub fn enlarge(&mut self, proxy: ProxyId, aabb: Aabb) {
        if !self.is_checked(proxy) {
            return;
        }
        let aabb = admitted(aabb);
        let mut slot = self.leaves[proxy.0 as usize].slot;
        if slot == ROOT {
            self.root_box = aabb;
            return;
        }
        let branch = &mut self.branches[slot as usize >> 1];
        branch.boxes[slot as usize & 1] = aabb;
        branch.enlarged |= 1 << (slot & 1);
        slot = branch.parent;
        while slot != ROOT {
            let branch = &mut self.branches[slot as usize >> 1];
            let (side, bit) = (slot as usize & 1, 1 << (slot & 1));
            // Slots above an enlarged slot are enlarged too, and boxes contain all boxes below them.
            if branch.enlarged & bit != 0 && branch.boxes[side].contains(&aabb) {
                return;
            }
            branch.enlarged |= bit;
            branch.boxes[side] = branch.boxes[side].union(&aabb);
            slot = branch.parent;
        }
        self.root_box = self.root_box.union(&aabb);
    }

    /// Changes the box of a leaf in place, but not the boxes above it: until [`refit`](Self::refit), queries
    /// may miss the leaf. Cheaper than [`enlarge`](Self::enlarge) if many leaves move.
    pub fn place(&mut self, proxy: ProxyId, aabb: Aabb) {
        if !self.is_checked(proxy) {
            return;
        }
        let slot = self.leaves[proxy.0 as usize].slot;
        if slot == ROOT {
            self.root_box = admitted(aabb);
            return;
        }
        self.branches[slot as usize >> 1].boxes[slot as usize & 1] = admitted(aabb);
        let mut slot = slot;
        while slot != ROOT {
            let (branch, bit) = (&mut self.branches[slot as usize >> 1], 1 << (slot & 1));
            if branch.enlarged & bit != 0 {
                return;
            }
            branch.enlarged |= bit;
            slot = branch.parent;
        }
    }

    /// Recomputes the boxes above leaves that were inserted or changed since the last rebuild. These boxes
    /// may shrink.
    pub fn refit(&mut self) {
        if self.root & LEAF != 0 || self.branches[self.root as usize].enlarged == 0 {
            return;
        }
        self.order.push(self.root);
        let mut opened = 0;
        while let Some(&branch) = self.order.get(opened) {
            opened += 1;
            let b = &self.branches[branch as usize];
            for side in 0..2 {
                if b.children[side] & LEAF == 0 && b.enlarged >> side & 1 != 0 {
                    self.order.push(b.children[side]);
                }
            }
        }
        // Children come after their parents, so in reverse order every box is computed before it is read.
        while let Some(branch) = self.order.pop() {
            let b = &self.branches[branch as usize];
            let (slot, joined) = (b.parent, b.boxes[0].union(&b.boxes[1]));
            match slot {
                ROOT => self.root_box = joined,
                _ => self.branches[slot as usize >> 1].boxes[slot as usize & 1] = joined,
            }
        }
    }

    /// The boxes of all nodes except the root.
    pub fn boxes(&self) -> impl Iterator<Item = Aabb> {
        self.branches.iter().filter(|branch| branch.height > 0).flat_map(|branch| branch.boxes)
    }

    /// A measure of the cost of queries: the summed surface area of all boxes in m², in 2D their perimeter in
    /// m. Infinite boxes are skipped. Takes O(n).
    pub fn cost(&self) -> f32 {
        self.boxes().map(|aabb| aabb.cost()).filter(|cost| cost.is_finite()).sum()
    }

    #[inline(always)]
    fn is_checked(&self, proxy: ProxyId) -> bool {
        let is_live = self.is_live(proxy);
        debug_assert!(is_live, "{proxy:?} names no leaf");
        is_live
    }

    #[inline(always)]
    pub(super) fn node_height(&self, node: u32) -> u16 {
        if node & LEAF == 0 { self.branches[node as usize].height } else { 0 }
    }

    #[inline(always)]
    pub(super) fn slot_box(&self, slot: u32) -> Aabb {
        if slot == ROOT { self.root_box } else { self.branches[slot as usize >> 1].boxes[slot as usize & 1] }
    }

    #[inline(always)]
    fn entry(&self, branch: u32, side: usize) -> Entry {
        let b = &self.branches[branch as usize];
        Entry { aabb: b.boxes[side], node: b.children[side], enlarged: b.enlarged >> side & 1 != 0 }
    }

    /// Writes a slot, and stores the slot's number in its node.
    #[inline(always)]
    pub(super) fn put(&mut self, slot: u32, entry: Entry) {
        if slot == ROOT {
            (self.root, self.root_box) = (entry.node, entry.aabb);
        } else {
            let (branch, side) = (&mut self.branches[slot as usize >> 1], slot as usize & 1);
            branch.boxes[side] = entry.aabb;
            branch.children[side] = entry.node;
            branch.enlarged = branch.enlarged & !(1 << side) | u16::from(entry.enlarged) << side;
        }
        if entry.node & LEAF != 0 {
            self.leaves[(entry.node & !LEAF) as usize].slot = slot;
        } else {
            self.branches[entry.node as usize].parent = slot;
        }
    }

    pub(super) fn new_leaf(&mut self, id: u32) -> u32 {
        self.len += 1;
        let leaf = Leaf { id, slot: ROOT };
        if self.free_leaf == NO_LEAF {
            self.leaves.push(leaf);
            return self.leaves.len() as u32 - 1;
        }
        let i = self.free_leaf;
        self.free_leaf = self.leaves[i as usize].slot & !LEAF;
        self.leaves[i as usize] = leaf;
        i
    }

    fn new_branch(&mut self) -> u32 {
        if self.free_branch == NONE {
            self.branches.push(FREE_BRANCH);
            return self.branches.len() as u32 - 1;
        }
        let i = self.free_branch;
        self.free_branch = self.branches[i as usize].parent;
        i
    }

    /// Inserts an unattached leaf into the tree.
    pub(super) fn attach(&mut self, leaf: u32, aabb: Aabb) {
        let new = Entry { aabb, node: LEAF | leaf, enlarged: true };
        if self.root == NONE {
            self.put(ROOT, new);
            return;
        }
        let slot = self.best_sibling(&aabb);
        let sibling = if slot == ROOT {
            // The root has no flag: a branch there is enlarged if any node below it is.
            let enlarged = self.root & LEAF != 0 || self.branches[self.root as usize].enlarged != 0;
            Entry { aabb: self.root_box, node: self.root, enlarged }
        } else {
            self.entry(slot >> 1, slot as usize & 1)
        };
        let branch = self.new_branch();
        self.branches[branch as usize] = FREE_BRANCH;
        self.put(branch << 1, sibling);
        self.put(branch << 1 | 1, new);
        self.put(slot, Entry { aabb: sibling.aabb.union(&aabb), node: branch, enlarged: true });
        self.update_upward(branch, true);
        if self.node_height(self.root) > MAX_HEIGHT {
            self.rebuild_full();
        }
    }

    /// Removes a leaf from the tree but keeps its record.
    fn detach(&mut self, leaf: u32) {
        let slot = self.leaves[leaf as usize].slot;
        if slot == ROOT {
            (self.root, self.root_box) = (NONE, Aabb::EMPTY);
            return;
        }
        let branch = slot >> 1;
        let sibling = self.entry(branch, slot as usize & 1 ^ 1);
        let parent = self.branches[branch as usize].parent;
        self.put(parent, sibling);
        self.branches[branch as usize] = Branch { parent: self.free_branch, ..FREE_BRANCH };
        self.free_branch = branch;
        if parent != ROOT {
            self.update_upward(parent >> 1, false);
        }
    }

    /// The slot whose content becomes the sibling of a new leaf.
    ///
    /// A sibling costs the area of the common box plus the growth of all boxes above it (Catto 2019). The
    /// search follows one path, towards the child that grows less. It ends when the new leaf's own area plus
    /// the growth so far is no better than the best sibling found. Of equal siblings the deepest wins, and a
    /// tie between children goes to the child of less height, so a tree of equal boxes stays shallow.
    fn best_sibling(&self, aabb: &Aabb) -> u32 {
        let own = aabb.cost();
        let mut node = self.root;
        let (mut best, mut best_cost) = (ROOT, self.root_box.union(aabb).cost());
        let mut inherited = best_cost - self.root_box.cost();
        while node & LEAF == 0 && inherited + own <= best_cost {
            let branch = &self.branches[node as usize];
            let joined = [0, 1].map(|i| branch.boxes[i].union(aabb).cost());
            let growth = [0, 1].map(|i| joined[i] - branch.boxes[i].cost());
            let side = if growth[0] == growth[1] {
                self.tied_side(branch, aabb)
            } else {
                usize::from(growth[1] < growth[0])
            };
            let direct = inherited + joined[side];
            if direct <= best_cost {
                (best, best_cost) = (node << 1 | side as u32, direct);
            }
            inherited += growth[side];
            node = branch.children[side];
        }
        best
    }

    /// The side for a box that makes both children grow equally (flat boxes have no surface in 3D): the child
    /// with the nearer centre, or at equal distance the child of less height.
    #[cold]
    fn tied_side(&self, branch: &Branch, aabb: &Aabb) -> usize {
        let away = branch.boxes.map(|b| (b.min - aabb.min + (b.max - aabb.max)).length_squared());
        let heights = branch.children.map(|c| self.node_height(c));
        usize::from(if away[0] == away[1] { heights[1] < heights[0] } else { away[1] < away[0] })
    }

    /// Updates heights and boxes from a branch up to the root, and rotates. After an insertion all branches
    /// above are enlarged; after a removal the walk ends at the first branch that does not change.
    fn update_upward(&mut self, mut branch: u32, inserted: bool) {
        loop {
            self.rotate(branch, inserted);
            let (height, joined) = self.measure(branch);
            let b = &mut self.branches[branch as usize];
            let mut changed = b.height != height;
            b.height = height;
            let slot = b.parent;
            changed |= self.slot_box(slot) != joined;
            if slot == ROOT {
                self.root_box = joined;
                return;
            }
            let above = &mut self.branches[slot as usize >> 1];
            above.boxes[slot as usize & 1] = joined;
            above.enlarged |= u16::from(inserted) << (slot & 1);
            if !changed && !inserted {
                return;
            }
            branch = slot >> 1;
        }
    }

    /// The height that a branch should have, and the box around its children.
    pub(super) fn measure(&self, branch: u32) -> (u16, Aabb) {
        let b = &self.branches[branch as usize];
        let height = b.children.map(|c| self.node_height(c));
        (1 + height[0].max(height[1]), b.boxes[0].union(&b.boxes[1]))
    }

    /// Exchanges a child with a grandchild on the other side: the higher grandchild if the heights of the
    /// children differ too much, otherwise the grandchild whose exchange shrinks the other child's box most.
    fn rotate(&mut self, branch: u32, for_area: bool) {
        let b = self.branches[branch as usize];
        let heights = b.children.map(|c| self.node_height(c));
        if heights[0].abs_diff(heights[1]) > MAX_IMBALANCE {
            let tall = usize::from(heights[1] > heights[0]);
            let grandchildren = self.branches[b.children[tall] as usize].children;
            let taller = self.node_height(grandchildren[1]) > self.node_height(grandchildren[0]);
            self.exchange(branch, tall, usize::from(taller));
            return;
        }
        if !for_area {
            return;
        }
        let (mut best, mut gain) = (None, 0.0);
        for side in 0..2 {
            if b.children[side] & LEAF != 0 {
                continue;
            }
            let child = &self.branches[b.children[side] as usize];
            let before = b.boxes[side].cost();
            for grandchild in 0..2 {
                let after = b.boxes[side ^ 1].union(&child.boxes[grandchild ^ 1]).cost();
                if before - after > gain {
                    (best, gain) = (Some((side, grandchild)), before - after);
                }
            }
        }
        if let Some((side, grandchild)) = best {
            self.exchange(branch, side, grandchild);
        }
    }

    /// Exchanges a grandchild below child `side` with the other child.
    fn exchange(&mut self, branch: u32, side: usize, grandchild: usize) {
        let child = self.branches[branch as usize].children[side];
        let (up, down) = (self.entry(child, grandchild), self.entry(branch, side ^ 1));
        self.put(child << 1 | grandchild as u32, down);
        self.put(branch << 1 | (side ^ 1) as u32, up);
        let (height, aabb) = self.measure(child);
        self.branches[child as usize].height = height;
        let enlarged = self.branches[child as usize].enlarged != 0;
        self.put(branch << 1 | side as u32, Entry { aabb, node: child, enlarged });
    }
}
