//! Queries of one tree: by a box, a point, a ray, a swept box, or distance.

use super::stack::Stack;
use super::tree::{Branch, LEAF, NONE, Tree};
use crate::math::{DIM, F32x4, Lane, Vector, max, min};
use crate::shape::Aabb;

impl Tree {
    /// Calls `found` with the user's id of every leaf whose box touches `aabb`, until `found` returns
    /// `false`. Returns `false` if it was stopped. The order depends on the tree.
    #[inline]
    pub fn query(&self, aabb: &Aabb, found: impl FnMut(u32) -> bool) -> bool {
        self.walk(|b| b.overlaps(aabb), found)
    }

    /// As [`query`](Self::query), for boxes that contain a point, the border included.
    #[inline]
    pub fn query_point(&self, point: Vector, found: impl FnMut(u32) -> bool) -> bool {
        self.query(&Aabb::new(point, point), found)
    }

    /// Visits the leaves whose boxes a ray hits, nearer branches first, with their ids and the present
    /// maximum distance.
    ///
    /// `hit` returns the new maximum distance: the distance of the hit, the present one (or more) to go on
    /// unchanged, or a negative one to stop. Distances are in lengths of `direction`, which need not be a
    /// unit vector; an infinite `max_distance` counts as `f32::MAX`. With a direction of zero the ray is its
    /// origin. NaN in the input hits nothing.
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
        mut hit: impl FnMut(u32, f32) -> f32,
    ) {
        if half.is_finite() && origin.is_finite() && direction.is_finite() {
            self.cast_sweep(&Sweep::new(half, origin, direction), max_distance, &mut hit);
        }
    }

    /// One walk for each combination of signs of the direction.
    fn cast_sweep(&self, sweep: &Sweep, limit: f32, hit: &mut dyn FnMut(u32, f32) -> f32) {
        match sweep.backward {
            0 => self.cast_towards::<0>(sweep, limit, hit),
            1 => self.cast_towards::<1>(sweep, limit, hit),
            2 => self.cast_towards::<2>(sweep, limit, hit),
            3 => self.cast_towards::<3>(sweep, limit, hit),
            4 => self.cast_towards::<4>(sweep, limit, hit),
            5 => self.cast_towards::<5>(sweep, limit, hit),
            6 => self.cast_towards::<6>(sweep, limit, hit),
            _ => self.cast_towards::<7>(sweep, limit, hit),
        }
    }

    #[inline(never)]
    fn cast_towards<const BACKWARD: usize>(
        &self,
        sweep: &Sweep,
        limit: f32,
        hit: &mut dyn FnMut(u32, f32) -> f32,
    ) {
        let root = |limit: f32| sweep.entry(&self.root_box, limit);
        let below = |branch: &Branch, limit: f32| sweep.entries::<BACKWARD>(&branch.boxes, limit);
        self.walk_ordered(limit, root, below, hit);
    }

    /// Visits leaves by the distance of their boxes from a point, nearer branches first, with their ids and
    /// the present maximum *squared* distance. `hit` returns the new squared maximum as in
    /// [`cast_ray`](Self::cast_ray). Leaves whose squared distance overflows are not found.
    pub fn query_nearest(&self, point: Vector, max_squared: f32, hit: impl FnMut(u32, f32) -> f32) {
        if point.is_finite() {
            let distance = |b: &Aabb| (b.min - point).max(point - b.max).max(Vector::ZERO).length_squared();
            let below = |branch: &Branch, _| [distance(&branch.boxes[0]), distance(&branch.boxes[1])];
            self.walk_ordered(max_squared, |_| distance(&self.root_box), below, hit);
        }
    }

    /// Walks depth first through all boxes that pass the test.
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

    /// Walks depth first, the nearer child first, through all boxes whose entry distance is at most the
    /// limit. `root` gives the entry distance of the box around all leaves, `below` the entry distances of a
    /// branch's children. The limit is finite, so infinity is always a miss.
    #[inline(always)]
    fn walk_ordered(
        &self,
        mut limit: f32,
        root: impl Fn(f32) -> f32,
        below: impl Fn(&Branch, f32) -> [f32; 2],
        mut hit: impl FnMut(u32, f32) -> f32,
    ) {
        if limit > f32::MAX {
            limit = f32::MAX;
        }
        let is_met = self.root != NONE && root(limit) <= limit;
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
                let [first, second] = below(branch, limit);
                // The nearer child is unpredictable, so neither choice is a jump.
                let far = usize::from(first <= second);
                let (near_at, far_at) = (min(first, second), if second < first { first } else { second });
                stack.push_if((branch.children[far], far_at), far_at <= limit);
                if near_at <= limit {
                    node = branch.children[far ^ 1];
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
/// Per axis, the ray is between the box's planes from `(near − o) / d` to `(far − o) / d`, with near and far
/// chosen by the sign of d (Williams et al., "An Efficient and Robust Ray–Box Intersection Algorithm", 2005).
/// The swept box's half size moves the planes outward. Rounding is monotonic, so every box around a hit box
/// is hit.
///
/// Both children of a branch are tested at once, in the lanes `[near, near, far, far]`. Distances to far
/// planes are negated, so all four lanes are maxima.
pub(super) struct Sweep {
    /// The origin, shifted by the half size, for the near and for the far planes.
    origins: [F32x4; DIM],
    /// 1 / d for the near planes, -(1 + 2 γ₃) / d for the far planes.
    inverses: [F32x4; DIM],
    /// One bit per axis: whether the ray goes backward, so the upper plane is the near one.
    backward: usize,
}

/// 1 + 2 γ₃: covers the rounding of the distances (Ize, "Robust BVH Ray Traversal", 2013).
const OUTWARD: f32 = 1.0 + 6.0 * f32::EPSILON;

impl Sweep {
    #[inline]
    pub fn new(half: Vector, origin: Vector, direction: Vector) -> Self {
        let (o, h, d) = (origin.to_array(), half.abs().to_array(), direction.to_array());
        let inverse = d.map(|d| 1.0 / d);
        let pairs = |near: f32, far: f32| F32x4::new([near, near, far, far]);
        let signed = |i: usize| if inverse[i] < 0.0 { -h[i] } else { h[i] };
        Self {
            origins: core::array::from_fn(|i| pairs(o[i] + signed(i), o[i] - signed(i))),
            inverses: core::array::from_fn(|i| pairs(inverse[i], -(inverse[i] * OUTWARD))),
            backward: (0..DIM).fold(0, |bits, i| bits | usize::from(inverse[i] < 0.0) << i),
        }
    }

    /// The distance at which the box is first touched; 0 if it is touched at the start, infinity if the
    /// distance exceeds the finite `limit`.
    #[inline]
    pub fn entry(&self, aabb: &Aabb, limit: f32) -> f32 {
        let (low, high) = (aabb.min.to_array(), aabb.max.to_array());
        let (mut enter, mut exit) = (0.0, -limit);
        for i in 0..DIM {
            let is_backward = self.backward >> i & 1 == 1;
            let (near, far) = if is_backward { (high[i], low[i]) } else { (low[i], high[i]) };
            enter = max((near - self.origins[i].get(0)) * self.inverses[i].get(0), enter);
            exit = max((far - self.origins[i].get(2)) * self.inverses[i].get(2), exit);
        }
        if enter <= -exit { enter } else { f32::INFINITY }
    }

    /// The distance at which each of two boxes is first touched; 0 if it is touched at the start, infinity if
    /// the distance exceeds the finite `limit`. `BACKWARD` equals `backward` of the sweep.
    #[inline(always)]
    fn entries<const BACKWARD: usize>(&self, boxes: &[Aabb; 2], limit: f32) -> [f32; 2] {
        let [low, high] = [boxes.map(|b| b.min.to_array()), boxes.map(|b| b.max.to_array())];
        let mut most = F32x4::new([0.0, 0.0, -limit, -limit]);
        for i in 0..DIM {
            let (near, far) = if BACKWARD >> i & 1 == 1 { (&high, &low) } else { (&low, &high) };
            let planes = F32x4::new([near[0][i], near[1][i], far[0][i], far[1][i]]);
            // For a ray in a plane of the box, 0 · ∞ is NaN, which the maximum drops.
            most = ((planes - self.origins[i]) * self.inverses[i]).max(most);
        }
        [0, 1].map(|i| if most.get(i) <= -most.get(2 + i) { most.get(i) } else { f32::INFINITY })
    }
}
