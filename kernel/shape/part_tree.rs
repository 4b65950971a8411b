//! The tree over the parts of a composite shape, built once.

use super::Aabb;
use crate::math::{DIM, Vector, min};

/// Maximum number of parts of a leaf. More parts make walks test boxes in vain; fewer make trees larger.
const LEAF_PARTS: usize = 4;

/// Below this depth ranges are halved by count, which bounds the depth of walks for any boxes.
const MAX_FREE_DEPTH: u32 = 24;

/// The capacity of a walk's stack: the free depth, plus the halvings of 2³² parts.
const STACK: usize = MAX_FREE_DEPTH as usize + 40;

/// For ray casts, boxes are grown by this share of the distance of the farthest box. So no facet is missed
/// whose own test, rounded to `f32`, reports a hit.
const ROOM_FOR_ROUNDING: f32 = 8.0 * f32::EPSILON;

/// A static tree of boxes. Its shape depends on the boxes alone, in their order.
#[derive(Clone, Debug, Default)]
pub struct PartTree {
    /// A branch is followed by its first child.
    nodes: Vec<Node>,
    /// The parts, leaf by leaf.
    order: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    aabb: Aabb,
    /// For a leaf its first place in `order`, for a branch the node of its second child.
    start: u32,
    /// The number of a leaf's parts; 0 for a branch.
    count: u32,
}

/// Adds the nodes of a tree one after another.
#[derive(Default)]
pub(super) struct Builder(PartTree);

impl Builder {
    /// A builder with room for a tree over this number of parts.
    pub(super) fn with_parts(count: usize) -> Self {
        Self(PartTree { nodes: Vec::with_capacity(count), order: Vec::with_capacity(count) })
    }

    /// Adds a leaf of up to [`LEAF_PARTS`] parts, and at least one. Returns its box.
    pub(super) fn leaf(&mut self, parts: impl Iterator<Item = u32>, aabb: Aabb) -> Aabb {
        let PartTree { nodes, order } = &mut self.0;
        let start = order.len() as u32;
        order.extend(parts);
        nodes.push(Node { aabb, start, count: order.len() as u32 - start });
        aabb
    }

    /// Adds a branch with two children. Returns its box.
    pub(super) fn branch(
        &mut self,
        first: impl FnOnce(&mut Self) -> Aabb,
        second: impl FnOnce(&mut Self) -> Aabb,
    ) -> Aabb {
        let node = self.0.nodes.len();
        self.0.nodes.push(Node { aabb: Aabb::EMPTY, start: 0, count: 0 });
        let first = first(self);
        self.0.nodes[node].start = self.0.nodes.len() as u32;
        let aabb = first.union(&second(self));
        self.0.nodes[node].aabb = aabb;
        aabb
    }

    /// The tree.
    pub(super) fn finish(self) -> PartTree {
        self.0
    }
}

/// A part to be sorted into the tree.
#[derive(Clone, Copy)]
struct Entry {
    part: u32,
    /// Twice the centre of its box.
    center: Vector,
}

impl PartTree {
    /// The tree over boxes, where the `i`-th box belongs to part `i`. Boxes that are not `min ≤ max` are
    /// never found.
    pub fn new(boxes: &[Aabb]) -> Self {
        if boxes.is_empty() {
            return Self::default();
        }
        let number = |c: f32| if c.is_finite() { c } else { 0.0 };
        let center = |b: &Aabb| Vector::from_array((b.min + b.max).to_array().map(number));
        let entries = boxes.iter().enumerate();
        let mut entries: Vec<Entry> =
            entries.map(|(i, b)| Entry { part: i as u32, center: center(b) }).collect();
        let around = Aabb::around(entries.iter().map(|entry| entry.center));
        let mut builder = Builder::with_parts(boxes.len());
        grow(&mut builder, &mut entries, around, boxes, 0);
        builder.finish()
    }

    /// The box around all parts; empty if there are none.
    pub fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, |root| root.aabb)
    }

    /// Calls `found` with every part whose leaf's box touches `aabb`, in an order that depends on the tree
    /// alone.
    #[inline]
    pub fn query(&self, aabb: &Aabb, mut found: impl FnMut(u32)) {
        self.walk(|b| b.overlaps(aabb), |parts| parts.iter().for_each(|part| found(*part)));
    }

    /// A lower bound of the distance from `around` to parts whose leaves' boxes do not touch `near`, or
    /// `limit` if that is less.
    pub fn gap_beyond(&self, near: &Aabb, around: &Aabb, limit: f32) -> f32 {
        let mut least = limit;
        self.visit_leaves(
            limit,
            |b| b.gap(around),
            |leaf, _, limit| {
                least = if leaf.overlaps(near) { limit } else { min(limit, leaf.gap(around)) };
                least
            },
        );
        least
    }

    /// Visits the parts in leaves whose boxes a ray enters before a limit, nearer branches first. `hit` gets
    /// a part and the current limit, and returns the new limit.
    pub fn cast_ray(&self, origin: Vector, direction: Vector, limit: f32, hit: impl FnMut(u32, f32) -> f32) {
        let bounds = self.bounds();
        let farthest = (bounds.min - origin).abs().max((bounds.max - origin).abs()).max_element();
        let room = ROOM_FOR_ROUNDING * farthest;
        let inverse = Vector::from_array(direction.to_array().map(|c| 1.0 / c));
        let entry = |b: &Aabb| b.grown(room).ray_entry(origin, inverse, f32::MAX).unwrap_or(f32::INFINITY);
        self.visit(limit, entry, hit);
    }

    /// Visits the parts of leaves by a distance of their boxes, nearer branches first, up to a limit. `entry`
    /// gives the distance of a box, infinity to skip it. `hit` gets a part and the current limit, and returns
    /// the new limit; the walk ends when the limit is negative.
    pub fn visit(&self, limit: f32, entry: impl Fn(&Aabb) -> f32, mut hit: impl FnMut(u32, f32) -> f32) {
        self.visit_leaves(limit, entry, |_, parts, mut limit| {
            for part in parts {
                limit = hit(*part, limit);
                if limit < 0.0 {
                    break;
                }
            }
            limit
        });
    }

    /// As [`visit`](Self::visit), but visits leaves, each with its box and its parts.
    #[inline(always)]
    fn visit_leaves(
        &self,
        mut limit: f32,
        entry: impl Fn(&Aabb) -> f32,
        mut hit: impl FnMut(&Aabb, &[u32], f32) -> f32,
    ) {
        let mut stack = [(0_u32, 0.0_f32); STACK];
        let mut len = 0;
        let Some(root) = self.nodes.first() else { return };
        let mut next = Some((0, entry(&root.aabb)));
        while let Some((index, at)) = next {
            next = None;
            // Infinity is a miss even without a limit.
            if at <= limit && at < f32::INFINITY {
                let node = &self.nodes[index as usize];
                if node.count == 0 {
                    let children = [index + 1, node.start];
                    let [first, second] =
                        children.map(|child| (child, entry(&self.nodes[child as usize].aabb)));
                    let (near, far) = if second.1 < first.1 { (second, first) } else { (first, second) };
                    stack[len] = far;
                    len += 1;
                    next = Some(near);
                } else {
                    let parts = &self.order[node.start as usize..(node.start + node.count) as usize];
                    limit = hit(&node.aabb, parts, limit);
                    if limit < 0.0 {
                        return;
                    }
                }
            }
            if next.is_none() && len > 0 {
                len -= 1;
                next = Some(stack[len]);
            }
        }
    }

    /// Walks depth first through all boxes that pass the test.
    #[inline(always)]
    fn walk(&self, test: impl Fn(&Aabb) -> bool, mut leaf: impl FnMut(&[u32])) {
        let mut stack = [0_u32; STACK];
        let mut len = 0;
        let mut next = if self.nodes.is_empty() { None } else { Some(0) };
        while let Some(index) = next {
            let node = &self.nodes[index];
            next = None;
            if test(&node.aabb) {
                if node.count > 0 {
                    leaf(&self.order[node.start as usize..(node.start + node.count) as usize]);
                } else {
                    stack[len] = node.start;
                    len += 1;
                    next = Some(index + 1);
                }
            }
            if next.is_none() && len > 0 {
                len -= 1;
                next = Some(stack[len] as usize);
            }
        }
    }
}

/// The box, or an empty one if it is inverted or NaN.
#[inline(always)]
fn admitted(aabb: &Aabb) -> Aabb {
    let (low, high) = (aabb.min.to_array(), aabb.max.to_array());
    if (0..DIM).all(|i| low[i] <= high[i]) { *aabb } else { Aabb::EMPTY }
}

/// Adds the tree over some parts. `around` is the box around their centres. Returns the box of the tree.
fn grow(builder: &mut Builder, entries: &mut [Entry], around: Aabb, boxes: &[Aabb], depth: u32) -> Aabb {
    if entries.len() <= LEAF_PARTS {
        let parts = entries.iter().map(|entry| entry.part);
        let aabb = parts.clone().fold(Aabb::EMPTY, |all, part| all.union(&admitted(&boxes[part as usize])));
        return builder.leaf(parts, aabb);
    }
    let (middle, [first_around, second_around]) = split(entries, around, depth);
    let (first, second) = entries.split_at_mut(middle);
    builder.branch(
        |builder| grow(builder, first, first_around, boxes, depth + 1),
        |builder| grow(builder, second, second_around, boxes, depth + 1),
    )
}

/// Sorts at least two parts into two groups that are not empty, at the middle of the longest side of their
/// centres' box. Returns the size of the first group, and the boxes around the centres of both groups.
fn split(entries: &mut [Entry], around: Aabb, depth: u32) -> (usize, [Aabb; 2]) {
    let size = (around.max - around.min).to_array();
    let axis = (1..DIM).fold(0, |best, i| if size[i] > size[best] { i } else { best });
    if depth < MAX_FREE_DEPTH {
        let middle = around.center().to_array()[axis];
        let mut boxes = [Aabb::EMPTY; 2];
        let (mut i, mut j) = (0, entries.len());
        while i < j {
            let center = entries[i].center;
            let is_second = !(center.to_array()[axis] <= middle);
            let aabb = &mut boxes[usize::from(is_second)];
            *aabb = Aabb { min: aabb.min.min(center), max: aabb.max.max(center) };
            if is_second {
                j -= 1;
                entries.swap(i, j);
            } else {
                i += 1;
            }
        }
        if i > 0 && i < entries.len() {
            return (i, boxes);
        }
    }
    let middle = entries.len() / 2;
    let key = |entry: &Entry| entry.center.to_array()[axis];
    entries.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.part.cmp(&b.part)));
    let around = |entries: &[Entry]| Aabb::around(entries.iter().map(|entry| entry.center));
    (middle, [around(&entries[..middle]), around(&entries[middle..])])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_query_finds_all_that_touches(
            corners in prop::collection::vec(([-9.0..9.0f32, -9.0..9.0, -9.0..9.0], 0.0..2.0f32), 0..80),
            copies in 1..40usize,
            (at, reach) in ([-9.0..9.0f32, -9.0..9.0, -9.0..9.0], 0.0..4.0f32),
        ) {
            let vector = |v: [f32; 3]| Vector::from_array(core::array::from_fn(|i| v[i]));
            let mut boxes: Vec<Aabb> =
                corners.iter().map(|(c, size)| Aabb::new(vector(*c), vector(*c) + Vector::ONE * *size)).collect();
            // No plane can separate equal boxes.
            if let Some(first) = boxes.first().copied() {
                boxes.extend((1..copies).map(|_| first));
            }
            let tree = PartTree::new(&boxes);
            let wanted = Aabb::new(vector(at), vector(at)).grown(reach);
            let mut found = vec![0; boxes.len()];
            tree.query(&wanted, |part| found[part as usize] += 1);
            for (i, b) in boxes.iter().enumerate() {
                prop_assert!(found[i] <= 1 && (found[i] == 1 || !b.overlaps(&wanted)), "part {i} found {} times", found[i]);
            }
        }
    }

    /// Also along axes, where a ray goes through as many boxes as possible.
    #[test]
    fn a_ray_visits_what_is_nearest_first() {
        let side = if DIM == 2 { 64 } else { 16_usize };
        let place = |k: usize| core::array::from_fn(|axis| (k / side.pow(axis as u32) % side) as f32 + 0.25);
        let boxes: Vec<Aabb> = (0..side.pow(DIM as u32))
            .map(|k| Vector::from_array(place(k)))
            .map(|corner| Aabb::new(corner, corner + Vector::ONE * 0.5))
            .collect();
        let tree = PartTree::new(&boxes);
        let middle = Vector::ONE * (0.5 * side as f32 + 0.45);
        for axis in 0..DIM {
            for toward in [1.0, -1.0] {
                let along =
                    Vector::from_array(core::array::from_fn(|i| if i == axis { toward } else { 0.0 }));
                let origin = middle - along * (2.0 * side as f32);
                let inverse = Vector::from_array(along.to_array().map(|c| 1.0 / c));
                let (mut visited, mut nearest) = (0, f32::INFINITY);
                tree.cast_ray(origin, along, f32::MAX, |part, limit| {
                    visited += 1;
                    let entry = boxes[part as usize].ray_entry(origin, inverse, limit);
                    nearest = entry.unwrap_or(nearest);
                    entry.unwrap_or(limit)
                });
                assert!(nearest < 1.6 * side as f32, "the first box of the row is hit, at {nearest} m");
                assert!(visited <= LEAF_PARTS, "{visited} boxes are visited along {along:?}");
            }
        }
    }

    #[test]
    fn boxes_without_numbers_do_not_end_a_build() {
        let odd = [Aabb::EMPTY, Aabb::new(Vector::ONE * f32::NAN, Vector::ONE), Aabb::EVERYTHING];
        let boxes: Vec<Aabb> = (0..100).map(|i| odd[i % 3]).collect();
        let tree = PartTree::new(&boxes);
        let mut found = 0;
        tree.query(&Aabb::new(Vector::ZERO, Vector::ZERO), |_| found += 1);
        assert!(found >= 33);
    }
}
