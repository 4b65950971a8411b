//! Reduction of many candidate points to at most four: the deepest point, and the points that span the
//! largest area with it.

use crate::manifold::{LocalManifold, LocalPoint};
use crate::math::{F32x4, Lane, Num, Vector, max};
use crate::tuning::manifold::{ABOUT_EQUAL, FLAT, HIGH, IN_THE_AIR, MARGIN};

/// The maximum number of candidates before reduction.
pub(super) const MAX_CANDIDATES: usize = 64;
/// A list of at most `N` candidates on the stack.
pub(super) struct Candidates<const N: usize> {
    list: [LocalPoint; N],
    count: usize,
}

impl<const N: usize> Candidates<N> {
    pub fn new() -> Self {
        Self { list: [LocalPoint::default(); N], count: 0 }
    }

    pub fn as_slice(&self) -> &[LocalPoint] {
        &self.list[..self.count]
    }

    /// Adds a candidate. A full list replaces the candidate with the largest separation.
    pub fn push(&mut self, candidate: LocalPoint) {
        if self.count < N {
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

/// Fills a manifold, whose normal is set, with at most four candidates; see [`Patch::reduce`].
///
/// Candidates of one face lie in a plane, so the outermost points support it. With several faces (`FACES`)
/// the outermost points may be in the air while the body leans on an edge between them. If one end of this
/// edge were dropped, it would sink in and be pushed out, which adds energy. So candidates above the deepest
/// candidate are worth less.
#[inline]
pub(super) fn keep<const FACES: bool>(list: &[LocalPoint], out: &mut LocalManifold) {
    let (kept, count) = match list.len() {
        0..=4 => ([0, 1, 2, 3], list.len()),
        5..=16 => Patch::<4>::of(list, out.normal).reduce::<FACES>(),
        _ => Patch::<16>::of(list, out.normal).reduce::<FACES>(),
    };
    out.count = 0;
    for k in &kept[..count] {
        out.add(list[*k]);
    }
}

/// The positions of candidates in the plane of contact, four side by side in each of `B` blocks. The last
/// may be unused.
pub(super) struct Patch<const B: usize> {
    pub x: [F32x4; B],
    pub y: [F32x4; B],
    /// Infinite for unused places.
    pub separation: [F32x4; B],
}

type Mask = <F32x4 as Lane>::Mask;

impl<const B: usize> Patch<B> {
    fn of(list: &[LocalPoint], normal: Vector) -> Self {
        let u = normal.any_orthonormal();
        let v = normal.cross(u);
        let none = F32x4::splat(f32::INFINITY);
        let mut patch = Self { x: [F32x4::ZERO; B], y: [F32x4::ZERO; B], separation: [none; B] };
        for (i, c) in list.iter().enumerate() {
            patch.x[i / 4].set(i % 4, u.dot(c.point));
            patch.y[i / 4].set(i % 4, v.dot(c.point));
            patch.separation[i / 4].set(i % 4, c.separation);
        }
        patch
    }

    /// The used places, as bits.
    #[inline(always)]
    fn present(&self) -> u64 {
        self.those_with(|_, present| present)
    }

    /// The candidates that pass a test, as bits.
    #[inline(always)]
    fn those_with(&self, holds: impl Fn(usize, Mask) -> Mask) -> u64 {
        let mut bits = 0;
        for k in 0..B {
            let present = self.separation[k].lt(F32x4::splat(f32::INFINITY));
            bits |= u64::from(F32x4::bits(F32x4::and(holds(k, present), present))) << (4 * k);
        }
        bits
    }

    /// A candidate's position.
    #[inline(always)]
    pub fn at(&self, i: usize) -> (f32, f32) {
        (F32x4::flat(&self.x)[i], F32x4::flat(&self.y)[i])
    }

    /// The first candidate of about the highest weighted worth above 0, and its worth.
    #[inline(always)]
    fn pick(&self, weights: &[F32x4; B], worth: impl Fn(F32x4, F32x4) -> F32x4) -> (usize, f32) {
        let (mut worths, mut scores) = ([F32x4::ZERO; B], [F32x4::ZERO; B]);
        let mut most = F32x4::ZERO;
        for k in 0..B {
            let present = self.separation[k].lt(F32x4::splat(f32::INFINITY));
            worths[k] = F32x4::select(present, worth(self.x[k], self.y[k]), F32x4::ZERO);
            scores[k] = worths[k] * weights[k];
            most = most.max(scores[k]);
        }
        let bar = F32x4::splat(ABOUT_EQUAL * greatest(most));
        let i = self.those_with(|k, _| bar.le(scores[k])).trailing_zeros() as usize % (4 * B);
        (i, F32x4::flat(&worths)[i])
    }

    /// The indices of the candidates to keep, and their number, at most four. The first is the deepest,
    /// within 0.1 % of the patch's size. Then come the farthest point from it, the point of the largest
    /// triangle, and the point that adds most to the triangle's area.
    pub fn reduce<const FACES: bool>(&self) -> ([usize; 4], usize) {
        let mut present = self.present();
        let count = present.count_ones() as usize;
        if count <= 4 {
            let mut kept = [0; 4];
            for k in &mut kept {
                *k = (present.trailing_zeros() & 63) as usize;
                present &= present.wrapping_sub(1);
            }
            return (kept, count);
        }
        let distance = |(x, y): (f32, f32)| {
            let (x, y) = (F32x4::splat(x), F32x4::splat(y));
            move |p: F32x4, q: F32x4| (p - x) * (p - x) + (q - y) * (q - y)
        };
        let from_any = distance(self.at(present.trailing_zeros() as usize));
        let (mut size, mut least) = (F32x4::ZERO, self.separation[0]);
        for k in 0..B {
            let here = self.separation[k].lt(F32x4::splat(f32::INFINITY));
            size = F32x4::select(here, from_any(self.x[k], self.y[k]), F32x4::ZERO).max(size);
            least = self.separation[k].min(least);
        }
        let size_squared = greatest(size);
        let (size, deepest) = (size_squared.sqrt(), -greatest(-least));
        let mut weights = [F32x4::ONE; B];
        if FACES {
            let (deepest, slope) = (F32x4::splat(deepest), F32x4::splat((1.0 - IN_THE_AIR) / (HIGH * size)));
            for (weight, separation) in weights.iter_mut().zip(self.separation) {
                *weight = (F32x4::ONE - (separation - deepest) * slope).max(F32x4::splat(IN_THE_AIR));
            }
        }
        let bar = F32x4::splat(MARGIN * size + deepest);
        let first = self.those_with(|k, _| self.separation[k].le(bar)).trailing_zeros() as usize % (4 * B);
        let a = self.at(first);
        let (second, far) = self.pick(&weights, distance(a));
        if !(far > FLAT as f32 * size_squared) {
            return ([first, 0, 0, 0], 1);
        }
        let b = self.at(second);
        let (third, area) = self.pick(&weights, |x, y| {
            let area = twice_area(a, b, x, y);
            area.max(-area)
        });
        if !(area > FLAT as f32 * size_squared) {
            return ([first, second, 0, 0], 2);
        }
        let c = self.at(third);
        let (cx, cy) = (F32x4::splat(c.0), F32x4::splat(c.1));
        let [p, q, r] = if twice_area(a, b, cx, cy).get(0) < 0.0 { [b, a, c] } else { [a, b, c] };
        let (fourth, added) = self.pick(&weights, |x, y| {
            -twice_area(p, q, x, y).min(twice_area(q, r, x, y)).min(twice_area(r, p, x, y))
        });
        let count = if added > FLAT as f32 * size_squared { 4 } else { 3 };
        ([first, second, third, fourth], count)
    }
}

/// The largest lane.
#[inline(always)]
fn greatest(v: F32x4) -> f32 {
    max(max(v.get(0), v.get(1)), max(v.get(2), v.get(3)))
}

/// Twice the areas of the triangles of two points and four third points, positive where they turn left.
#[inline(always)]
fn twice_area(p: (f32, f32), q: (f32, f32), x: F32x4, y: F32x4) -> F32x4 {
    let (dx, dy) = (F32x4::splat(q.0 - p.0), F32x4::splat(q.1 - p.1));
    dx * (y - F32x4::splat(p.1)) - dy * (x - F32x4::splat(p.0))
}
