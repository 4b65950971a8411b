//! Builds many branches at once: whole trees, and the part of a tree above unchanged subtrees.

use super::stack::Stack;
use super::tree::{Branch, Entry, FREE_BRANCH, Item, LEAF, MAX_HEIGHT, NONE, ProxyId, ROOT, Tree, admitted};
use crate::math::{DIM, Vector};
use crate::shape::Aabb;

/// The number of bins of a split. More bins make builds slower and trees hardly better.
const BINS: usize = 8;
/// Splits below this depth halve the number of items, which bounds the height for any boxes.
const MAX_FREE_DEPTH: u32 = 40;

impl Tree {
    /// Replaces the tree by a tree of `(id, box)` pairs. The `i`-th pair becomes `ProxyId(i)`.
    pub fn build(&mut self, leaves: &[(u32, Aabb)]) {
        self.clear();
        for (i, (id, aabb)) in leaves.iter().enumerate() {
            let leaf = self.new_leaf(*id);
            debug_assert_eq!(leaf as usize, i, "a cleared tree numbers from 0");
            self.items.push(Item { aabb: admitted(*aabb), node: LEAF | leaf });
        }
        self.build_all();
    }

    /// Adds many leaves and appends their proxies to `proxies` in order. Rebuilds the tree if the new leaves
    /// are many compared with the leaves already in it.
    pub fn insert_many(&mut self, leaves: &[(u32, Aabb)], proxies: &mut Vec<ProxyId>) {
        if leaves.len() * 8 < self.len() {
            proxies.extend(leaves.iter().map(|(id, aabb)| self.insert(*id, *aabb)));
            return;
        }
        self.gather_leaves();
        for (id, aabb) in leaves {
            let leaf = self.new_leaf(*id);
            self.items.push(Item { aabb: admitted(*aabb), node: LEAF | leaf });
            proxies.push(ProxyId(leaf));
        }
        self.build_all();
    }

    /// Rebuilds all branches and sorts them in the order of a walk.
    pub fn rebuild_full(&mut self) {
        self.gather_leaves();
        self.build_all();
    }

    /// Rebuilds the branches above enlarged and inserted leaves. The largest subtrees without such leaves
    /// stay as they are. Returns the number of subtrees and leaves that were sorted, 0 if nothing had
    /// changed.
    ///
    /// The cost depends on the changed part of the tree.
    pub fn rebuild_partial(&mut self) -> usize {
        if self.root & LEAF != 0 || self.branches[self.root as usize].enlarged == 0 {
            return 0;
        }
        // The branches to rebuild are also the queue of branches to open.
        self.order.push(self.root);
        let mut opened = 0;
        while let Some(&branch) = self.order.get(opened) {
            opened += 1;
            let b = &self.branches[branch as usize];
            for side in 0..2 {
                let node = b.children[side];
                if node & LEAF == 0 && b.enlarged >> side & 1 != 0 {
                    self.order.push(node);
                } else {
                    self.items.push(Item { aabb: b.boxes[side], node });
                }
            }
        }
        let sorted = self.items.len();
        self.order.sort_unstable();
        self.build_over_items();
        if self.node_height(self.root) > MAX_HEIGHT {
            self.rebuild_full();
        }
        sorted
    }

    fn gather_leaves(&mut self) {
        for (i, leaf) in self.leaves.iter().enumerate() {
            if leaf.slot == ROOT {
                self.items.push(Item { aabb: self.root_box, node: LEAF | i as u32 });
            } else if leaf.slot & LEAF == 0 {
                let aabb = self.branches[leaf.slot as usize >> 1].boxes[leaf.slot as usize & 1];
                self.items.push(Item { aabb, node: LEAF | i as u32 });
            }
        }
    }

    /// Builds a tree over `items`, which are all leaves.
    fn build_all(&mut self) {
        self.branches.clear();
        self.free_branch = NONE;
        (self.root, self.root_box) = (NONE, Aabb::EMPTY);
        let branches = self.items.len().saturating_sub(1);
        self.branches.resize(branches, FREE_BRANCH);
        self.order.extend(0..branches as u32);
        self.build_over_items();
    }

    /// Builds a tree over `items` with the branches in `order`, one fewer than items. Empties both.
    ///
    /// Items are split and branches linked top down, in the order of a walk. Then boxes and heights are
    /// computed in the reverse order, children before parents.
    fn build_over_items(&mut self) {
        let mut items = core::mem::take(&mut self.items);
        let mut order = core::mem::take(&mut self.order);
        let mut branches = order.iter();
        let mut stack = Stack::new();
        if !items.is_empty() {
            stack.push(Task { slot: ROOT, start: 0, end: items.len() as u32, depth: 0 });
        }
        while let Some(Task { slot, start, end, depth }) = stack.pop() {
            let range = &mut items[start as usize..end as usize];
            if let [item] = range {
                self.put(slot, Entry { aabb: item.aabb, node: item.node, enlarged: false });
                continue;
            }
            let middle = start + split(range, depth) as u32;
            let branch = *branches.next().expect("a binary tree has one branch fewer than leaves");
            self.branches[branch as usize] = FREE_BRANCH;
            self.put(slot, Entry { aabb: Aabb::EMPTY, node: branch, enlarged: false });
            stack.push(Task { slot: branch << 1 | 1, start: middle, end, depth: depth + 1 });
            stack.push(Task { slot: branch << 1, start, end: middle, depth: depth + 1 });
        }
        for &branch in order.iter().rev() {
            let (height, joined) = self.measure(branch);
            let Branch { height: h, parent, .. } = &mut self.branches[branch as usize];
            *h = height;
            match *parent {
                ROOT => self.root_box = joined,
                slot => self.branches[slot as usize >> 1].boxes[slot as usize & 1] = joined,
            }
        }
        items.clear();
        order.clear();
        (self.items, self.order) = (items, order);
    }
}

/// A range of items that becomes the content of a slot.
#[derive(Clone, Copy, Default)]
struct Task {
    slot: u32,
    start: u32,
    end: u32,
    depth: u32,
}

/// Twice the centre, with 0 for components that are NaN or overflow.
#[inline(always)]
fn center(aabb: &Aabb) -> Vector {
    Vector::from_array((aabb.min + aabb.max).to_array().map(|c| if c.is_finite() { c } else { 0.0 }))
}

/// Splits at least two items into two groups that are not empty. Returns the size of the first.
fn split(items: &mut [Item], depth: u32) -> usize {
    if items.len() == 2 {
        return 1;
    }
    let (mut low, mut high) = (center(&items[0].aabb), center(&items[0].aabb));
    for item in &items[1..] {
        let c = center(&item.aabb);
        (low, high) = (low.min(c), high.max(c));
    }
    let size = (high - low).to_array();
    let axis = (1..DIM).fold(0, |best, i| if size[i] > size[best] { i } else { best });
    if depth < MAX_FREE_DEPTH && size[axis].is_finite() && size[axis] > 0.0 {
        let scale = BINS as f32 / size[axis];
        let start = low.to_array()[axis];
        let bin =
            |item: &Item| (((center(&item.aabb).to_array()[axis] - start) * scale) as usize).min(BINS - 1);
        if let Some(last) = best_bin(items, bin) {
            return partition(items, |item| bin(item) <= last);
        }
    }
    let middle = items.len() / 2;
    let key = |item: &Item| center(&item.aabb).to_array()[axis];
    items.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.node.cmp(&b.node)));
    middle
}

/// The last bin of the first group, for the split that minimizes area × items summed over both sides. `None`
/// if all items are in one bin or no sum is finite.
fn best_bin(items: &[Item], bin: impl Fn(&Item) -> usize) -> Option<usize> {
    let mut boxes = [Aabb::EMPTY; BINS];
    let mut counts = [0u32; BINS];
    for item in items {
        let i = bin(item);
        boxes[i] = boxes[i].union(&item.aabb);
        counts[i] += 1;
    }
    // The number of items only scales the sums, which then stay finite for huge boxes.
    let share = 1.0 / items.len() as f32;
    let mut right = [f32::INFINITY; BINS];
    let (mut joined, mut count) = (Aabb::EMPTY, 0);
    for i in (1..BINS).rev() {
        joined = joined.union(&boxes[i]);
        count += counts[i];
        if count > 0 {
            right[i] = joined.cost() * (count as f32 * share);
        }
    }
    let (mut best, mut best_cost) = (None, f32::INFINITY);
    (joined, count) = (Aabb::EMPTY, 0);
    for i in 0..BINS - 1 {
        joined = joined.union(&boxes[i]);
        count += counts[i];
        if count > 0 {
            let cost = joined.cost() * (count as f32 * share) + right[i + 1];
            if cost < best_cost {
                (best, best_cost) = (Some(i), cost);
            }
        }
    }
    best
}

/// Moves the items for which `first` holds to the front. Returns their number.
fn partition(items: &mut [Item], first: impl Fn(&Item) -> bool) -> usize {
    let (mut i, mut j) = (0, items.len());
    while i < j {
        if first(&items[i]) {
            i += 1;
        } else {
            j -= 1;
            items.swap(i, j);
        }
    }
    i
}
