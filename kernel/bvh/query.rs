//! Queries of one tree: by a box, a point, a ray, a swept box, or distance.

use super::stack::Stack;
use super::tree::{LEAF, NONE, Tree};
use crate::math::{DIM, Vector, max, min};
use crate::shape::Aabb;

impl Tree {
    /// Calls `found` with the user's id of every leaf whose box touches `aabb`, until it returns `false`. Returns `false` if
    /// it was stopped. The order depends on the tree.
    #[inline]
    pub fn query(&self, aabb: &Aabb, found: impl FnMut(u32) -> bool) -> bool {
        self.walk(|b| b.overlaps(aabb), found)
    }

    /// As [`query`](Self::query), for boxes that contain a point, the border included.
    #[inline]
    pub fn query_point(&self, point: Vector, found: impl FnMut(u32) -> bool) -> bool {
        self.query(&Aabb::new(point, point), found)
    }

    /// Visits the leaves whose boxes a ray hits, nearer branches first, with their ids and the present maximum distance.
    ///
    /// `hit` returns the new maximum distance: that of the hit, the same (or more) to go on unchanged, negative to stop.
    /// Distances are in lengths of `direction`, which need not be a unit vector; an infinite `max_distance` counts as
    /// `f32::MAX`. With a direction of zero the ray is its origin. NaN in the input hits nothing.
    #[inline]
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        hit: impl FnMut(u32, f32) -> f32,
    ) {
        self.cast_box(Vector::ZERO, origin, direction, max_distance, hit);
    }

    /// As [`cast_ray`](Self::cast_ray), for a box of half size `half` whose centre moves along the ray.
    #[inline]
    pub fn cast_box(
        &self,
        half: Vector,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        hit: impl FnMut(u32, f32) -> f32,
    ) {
        if half.is_finite() && origin.is_finite() && direction.is_finite() {
            let sweep = Sweep::new(half, origin, direction);
            self.walk_ordered(max_distance, |b, limit| sweep.entry(b, limit), hit);
        }
    }

    /// Visits leaves by the distance of their boxes from a point, nearer branches first, with their ids and the present
    /// maximum *squared* distance. `hit` returns the new one as in [`cast_ray`](Self::cast_ray), squared. Leaves whose squared
    /// distance overflows are not found.
    pub fn query_nearest(&self, point: Vector, max_squared: f32, hit: impl FnMut(u32, f32) -> f32) {
        if point.is_finite() {
            let distance =
                |b: &Aabb, _| (b.min - point).max(point - b.max).max(Vector::ZERO).length_squared();
            self.walk_ordered(max_squared, distance, hit);
        }
    }

    /// Depth first through all boxes that pass the test.
    #[inline(always)]
    fn walk(&self, test: impl Fn(&Aabb) -> bool, mut found: impl FnMut(u32) -> bool) -> bool {
        if self.root == NONE || !test(&self.root_box) {
            return true;
        }
        let mut stack = Stack::new();
        let mut node = self.root;
        loop {
            if node & LEAF != 0 {
                if !found(self.leaves[(node & !LEAF) as usize].id) {
                    return false;
                }
            } else {
                let branch = &self.branches[node as usize];
                let [first, second] = branch.children;
                let (in_first, in_second) = (test(&branch.boxes[0]), test(&branch.boxes[1]));
                if in_first {
                    if in_second {
                        stack.push(second);
                    }
                    node = first;
                    continue;
                }
                if in_second {
                    node = second;
                    continue;
                }
            }
            match stack.pop() {
                Some(next) => node = next,
                None => return true,
            }
        }
    }

    /// Depth first, the nearer child first, through all boxes whose `entry` is at most the limit. The limit is finite, so that
    /// infinity is always a miss.
    #[inline(always)]
    fn walk_ordered(
        &self,
        mut limit: f32,
        entry: impl Fn(&Aabb, f32) -> f32,
        mut hit: impl FnMut(u32, f32) -> f32,
    ) {
        if limit > f32::MAX {
            limit = f32::MAX;
        }
        let is_met = self.root != NONE && entry(&self.root_box, limit) <= limit;
        if !is_met {
            return;
        }
        let mut stack = Stack::<(u32, f32)>::new();
        let mut node = self.root;
        loop {
            if node & LEAF != 0 {
                let answer = hit(self.leaves[(node & !LEAF) as usize].id, limit);
                if answer < 0.0 {
                    return;
                }
                limit = min(answer, limit);
            } else {
                let branch = &self.branches[node as usize];
                let [mut near, mut far] = branch.children;
                let [mut near_at, mut far_at] = [0, 1].map(|i| entry(&branch.boxes[i], limit));
                if far_at < near_at {
                    (near, far) = (far, near);
                    (near_at, far_at) = (far_at, near_at);
                }
                if near_at <= limit {
                    if far_at <= limit {
                        stack.push((far, far_at));
                    }
                    node = near;
                    continue;
                }
            }
            node = loop {
                match stack.pop() {
                    Some((next, at)) if at <= limit => break next,
                    Some(_) => {}
                    None => return,
                }
            };
        }
    }
}

/// A box that moves along a ray, prepared for slab tests.
///
/// Per axis, the ray is between the box's planes from `(near − o) / d` to `(far − o) / d`, with near and
/// far chosen by the sign of d (Williams et al., "An Efficient and Robust Ray–Box Intersection
/// Algorithm", 2005); the swept box's half size moves the planes outward. Rounding is monotonic, so a box around a hit box is
/// hit.
pub(super) struct Sweep {
    /// The origin, shifted by the half size for the near planes.
    near_origin: [f32; DIM],
    /// The origin, shifted by the half size for the far planes.
    far_origin: [f32; DIM],
    inverse: [f32; DIM],
    backward: [bool; DIM],
}

/// 1 + 2 γ₃: covers the rounding of the distances (Ize, "Robust BVH Ray Traversal", 2013).
const OUTWARD: f32 = 1.0 + 6.0 * f32::EPSILON;

impl Sweep {
    #[inline]
    pub fn new(half: Vector, origin: Vector, direction: Vector) -> Self {
        let (o, h, d) = (origin.to_array(), half.abs().to_array(), direction.to_array());
        let inverse = d.map(|d| 1.0 / d);
        let backward = inverse.map(|i| i < 0.0);
        let signed = |i: usize| if backward[i] { -h[i] } else { h[i] };
        Self {
            near_origin: core::array::from_fn(|i| o[i] + signed(i)),
            far_origin: core::array::from_fn(|i| o[i] - signed(i)),
            inverse,
            backward,
        }
    }

    /// The distance at which the box is first touched, 0 if from the start; infinity if beyond the finite `limit`.
    #[inline(always)]
    pub fn entry(&self, aabb: &Aabb, limit: f32) -> f32 {
        let (low, high) = (aabb.min.to_array(), aabb.max.to_array());
        let (mut enter, mut exit) = (0.0, limit);
        for i in 0..DIM {
            let (near, far) = if self.backward[i] { (high[i], low[i]) } else { (low[i], high[i]) };
            // For a ray along a plane 0 · ∞ is NaN, which the min/max rule drops.
            enter = max((near - self.near_origin[i]) * self.inverse[i], enter);
            exit = min((far - self.far_origin[i]) * self.inverse[i] * OUTWARD, exit);
        }
        if enter <= exit { enter } else { f32::INFINITY }
    }
}
