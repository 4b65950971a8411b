//! Many candidate points become at most four: the deepest, and those that span the most area with it.

use crate::math::{Vector, max, min};

/// The most candidates a manifold function collects before it reduces.
pub(super) const MAX_CANDIDATES: usize = 64;
/// A challenger must be this much better than the incumbent. Candidates of about equal worth then keep
/// their order from step to step, so that impulses find their points again.
const CHALLENGE: f32 = 1.05;
/// By how much a point must be deeper than the incumbent, as a share of the patch's size.
const DEEPER: f32 = 1.0e-3;
/// A point that adds less than this share of the patch's squared size adds nothing.
const FLAT: f32 = 1.0e-6;

/// A contact point that may be chosen.
#[derive(Clone, Copy, Default)]
pub(super) struct Candidate {
    pub point: Vector,
    pub separation: f32,
    pub feature: u32,
}

/// A list of candidates on the stack.
pub(super) struct Candidates {
    list: [Candidate; MAX_CANDIDATES],
    count: usize,
}

impl Candidates {
    pub fn new() -> Self {
        Self { list: [Candidate::default(); MAX_CANDIDATES], count: 0 }
    }

    pub fn as_slice(&self) -> &[Candidate] {
        &self.list[..self.count]
    }

    /// Adds a candidate; when full, in place of the one with the largest separation.
    pub fn push(&mut self, candidate: Candidate) {
        if self.count < MAX_CANDIDATES {
            self.list[self.count] = candidate;
            self.count += 1;
            return;
        }
        let mut shallowest = 0;
        for (i, c) in self.list.iter().enumerate() {
            if c.separation > self.list[shallowest].separation {
                shallowest = i;
            }
        }
        if candidate.separation < self.list[shallowest].separation {
            self.list[shallowest] = candidate;
        }
    }
}

/// A candidate by its place in the plane of contact.
#[derive(Clone, Copy, Default)]
pub(super) struct Planar {
    pub x: f32,
    pub y: f32,
    pub separation: f32,
}

/// The numbers of the candidates to keep, and how many; see [`reduce_planar`].
#[inline]
pub(super) fn reduce(list: &[Candidate], normal: Vector) -> ([usize; 4], usize) {
    if list.len() <= 4 {
        return ([0, 1, 2, 3], list.len());
    }
    let u = normal.any_orthonormal();
    let v = normal.cross(u);
    let mut planar = [Planar::default(); MAX_CANDIDATES];
    for (p, c) in planar.iter_mut().zip(list) {
        *p = Planar { x: u.dot(c.point), y: v.dot(c.point), separation: c.separation };
    }
    reduce_planar(&planar[..list.len()])
}

/// The numbers of the candidates to keep, and how many: at most four. The first is the deepest but for
/// 0.1 % of the patch's size; then the one farthest from it, the largest triangle, and the point that
/// adds most to the triangle's area.
pub(super) fn reduce_planar(list: &[Planar]) -> ([usize; 4], usize) {
    if list.len() <= 4 {
        return ([0, 1, 2, 3], list.len());
    }
    let square = |p: &Planar, q: &Planar| (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
    let size_squared = list.iter().fold(0.0, |m, c| max(m, square(c, &list[0])));
    let margin = DEEPER * size_squared.sqrt();
    let (first, _) = pick(list, f32::NEG_INFINITY, |c| -c.separation, |best| best + margin);
    let a = list[first];
    let (second, far) = pick(list, 0.0, |c| square(c, &a), |best| best * CHALLENGE);
    if !(far > FLAT * size_squared) {
        return ([first, 0, 0, 0], 1);
    }
    let b = list[second];
    let twice_area =
        |p: &Planar, q: &Planar, r: &Planar| (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    let (third, area) = pick(list, 0.0, |c| twice_area(&a, &b, c).abs(), |best| best * CHALLENGE);
    if !(area > FLAT * size_squared) {
        return ([first, second, 0, 0], 2);
    }
    let c = list[third];
    let [p, q, r] = if twice_area(&a, &b, &c) < 0.0 { [b, a, c] } else { [a, b, c] };
    let outside = |d: &Planar| -min(min(twice_area(&p, &q, d), twice_area(&q, &r, d)), twice_area(&r, &p, d));
    let (fourth, added) = pick(list, 0.0, outside, |best| best * CHALLENGE);
    let count = if added > FLAT * size_squared { 4 } else { 3 };
    ([first, second, third, fourth], count)
}

/// The candidate of most worth, where one must be above `bar` of the incumbent's; and its worth.
#[inline(always)]
fn pick(
    list: &[Planar],
    start: f32,
    worth: impl Fn(&Planar) -> f32,
    bar: impl Fn(f32) -> f32,
) -> (usize, f32) {
    let (mut index, mut best, mut above) = (0, start, start);
    for (i, c) in list.iter().enumerate() {
        let value = worth(c);
        let better = value > above;
        index = if better { i } else { index };
        best = if better { value } else { best };
        above = bar(best);
    }
    (index, best)
}
