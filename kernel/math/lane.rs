//! Lanes: one `f32`, or several computed side by side.

use super::double::Double;
use super::num::Num;
use core::fmt::Debug;
use core::ops::{AddAssign, Mul, SubAssign};

/// Four floats loaded and stored as one: a quarter or a half of a body row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(16))]
pub struct Quad(pub [f32; 4]);

impl AddAssign for Quad {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a += b;
        }
    }
}

impl SubAssign for Quad {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a -= b;
        }
    }
}

impl Mul for Quad {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, other: Self) -> Self {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a *= b;
        }
        self
    }
}

/// Proof that the CPU has AVX2. Only [`find`](Self::find) makes one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx2(());

impl Avx2 {
    /// Asks the CPU.
    pub fn find() -> Option<Self> {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            return Some(Self(()));
        }
        None
    }
}

/// The number of floats in a lane of rows. Results have the same bits with any width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// On every CPU: SSE2, NEON, or plain arrays.
    Four,
    /// With AVX2.
    Eight(Avx2),
}

impl Default for Width {
    /// The widest lane of this CPU.
    fn default() -> Self {
        Self::of(false)
    }
}

impl Width {
    /// The widest lane of this CPU, or four floats if `narrow`.
    pub fn of(narrow: bool) -> Self {
        match Avx2::find() {
            Some(avx2) if !narrow => Self::Eight(avx2),
            _ => Self::Four,
        }
    }
}

/// Indices of rows, one for each lane.
pub trait Ids: Copy + Debug + Send + Sync {
    /// The same index in every lane.
    fn splat(id: u32) -> Self;
    /// The indices, lane by lane.
    fn lanes(&self) -> &[u32];
    /// Writes lane `i`.
    fn set(&mut self, i: usize, id: u32);
}

impl<const W: usize> Ids for [u32; W] {
    fn splat(id: u32) -> Self {
        [id; W]
    }
    fn lanes(&self) -> &[u32] {
        self
    }
    fn set(&mut self, i: usize, id: u32) {
        self[i] = id;
    }
}

/// `WIDTH` floats that are computed at once. A lane's result never depends on its neighbours.
///
/// `max` and `min` follow `a > b ? a : b` and `a < b ? a : b`, so a NaN in either operand gives `b`, on every
/// instruction set.
pub trait Lane: Num {
    /// The number of floats side by side.
    const WIDTH: usize;
    /// Whether lanes of one row may have bodies in common.
    const SHARES: bool = false;
    /// The result of a comparison, lane by lane.
    type Mask: Copy;
    /// The index of a row for each lane.
    type Ids: Ids;
    /// One `f64` for each float.
    type Double: Double;

    /// The same value in every lane.
    fn splat(value: f32) -> Self;
    /// Reads lane `i`. For setting up and taking down rows, not for hot loops.
    fn get(&self, i: usize) -> f32;
    /// Writes lane `i`. For setting up and taking down rows, not for hot loops.
    fn set(&mut self, i: usize, value: f32);
    /// `a > b ? a : b`.
    fn max(self, other: Self) -> Self;
    /// `a < b ? a : b`.
    fn min(self, other: Self) -> Self;
    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// `self == other`.
    fn eq(self, other: Self) -> Self::Mask;
    /// Either of two masks.
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Both of two masks.
    fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Whether the mask is set in any lane. Use it only to skip work that would select the old value.
    fn any(mask: Self::Mask) -> bool;
    /// The mask as bits, lane 0 lowest.
    fn bits(mask: Self::Mask) -> u32;
    /// `mask ? a : b`, lane by lane.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// The same values as `f64`.
    fn double(self) -> Self::Double;
    /// Rounds `f64`.
    fn of_double(values: Self::Double) -> Self;
    /// Loads one quad for each lane through `fetch` and transposes: element `k` of the result holds
    /// float `k` of every quad.
    fn gather<'a>(ids: &Self::Ids, fetch: impl Fn(u32) -> &'a Quad) -> [Self; 4];
    /// The inverse of [`gather`](Self::gather): passes each lane's quad to `put`.
    fn scatter(values: [Self; 4], ids: &Self::Ids, put: impl FnMut(u32, Quad));
}

impl Lane for f32 {
    const WIDTH: usize = 1;
    type Mask = bool;
    type Ids = [u32; 1];
    type Double = f64;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        value
    }
    #[inline(always)]
    fn get(&self, _: usize) -> f32 {
        *self
    }
    #[inline(always)]
    fn set(&mut self, _: usize, value: f32) {
        *self = value;
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        max(self, other)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        min(self, other)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn eq(self, other: Self) -> bool {
        self == other
    }
    #[inline(always)]
    fn or(a: bool, b: bool) -> bool {
        a | b
    }
    #[inline(always)]
    fn and(a: bool, b: bool) -> bool {
        a & b
    }
    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }
    #[inline(always)]
    fn bits(mask: bool) -> u32 {
        u32::from(mask)
    }
    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn double(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn of_double(value: f64) -> Self {
        value as f32
    }
    #[inline(always)]
    fn gather<'a>(ids: &[u32; 1], fetch: impl Fn(u32) -> &'a Quad) -> [Self; 4] {
        fetch(ids[0]).0
    }
    #[inline(always)]
    fn scatter(values: [Self; 4], ids: &[u32; 1], mut put: impl FnMut(u32, Quad)) {
        put(ids[0], Quad(values));
    }
}

/// The inverse of a number, or 0 where the number is not positive.
#[inline(always)]
pub(crate) fn inverse_of_positive<N: Lane>(number: N) -> N {
    let is_positive = N::ZERO.lt(number);
    N::select(is_positive, N::ONE / N::select(is_positive, number, N::ONE), N::ZERO)
}

/// The larger of two values by the rule `a > b ? a : b`, on every instruction set: with a NaN in
/// either place the result is `b`.
#[inline(always)]
pub fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller of two values by the rule `a < b ? a : b`; a NaN in either place gives `b`.
#[inline(always)]
pub fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `value` clamped to `low` … `high`; NaN becomes `high`.
#[inline(always)]
pub fn clamp(value: f32, low: f32, high: f32) -> f32 {
    max(min(value, high), low)
}

#[cfg(test)]
mod tests {
    use super::super::F32x4;
    use super::*;

    fn pack(v: [f32; 4]) -> F32x4 {
        let mut out = F32x4::default();
        for (i, v) in v.iter().enumerate() {
            out.set(i, *v);
        }
        out
    }

    /// Every operation of the wide lane gives the same bits as the scalar lane.
    #[test]
    fn wide_lane_equals_scalar_lane() {
        let samples = [0.0, -0.0, 1.5, -2.25, 1e-38, 3e38, f32::NAN, f32::INFINITY, -7.0, 0.1];
        for &x in &samples {
            for &y in &samples {
                let (a, b) = (pack([x, y, x, 1.0]), pack([y, x, -y, x]));
                let same = |wide: F32x4, f: &dyn Fn(f32, f32) -> f32| {
                    for i in 0..4 {
                        let want = f(a.get(i), b.get(i));
                        let got = wide.get(i);
                        assert!(
                            got.to_bits() == want.to_bits() || (got.is_nan() && want.is_nan()),
                            "{} {} gave {got}, not {want}",
                            a.get(i),
                            b.get(i)
                        );
                    }
                };
                same(a + b, &|a, b| a + b);
                same(a - b, &|a, b| a - b);
                same(a * b, &|a, b| a * b);
                same(a / b, &|a, b| a / b);
                same(-a, &|a, _| -a);
                same(Lane::max(a, b), &|a, b| Lane::max(a, b));
                same(Lane::min(a, b), &|a, b| Lane::min(a, b));
                same(Num::sqrt(a), &|a, _| a.sqrt());
                same(F32x4::select(a.lt(b), a, b), &|a, b| if a < b { a } else { b });
                same(F32x4::select(a.le(b), a, b), &|a, b| if a <= b { a } else { b });
                same(F32x4::select(Lane::eq(a, b), a, -b), &|a, b| if a == b { a } else { -b });
            }
        }
    }

    #[test]
    fn gather_then_scatter_returns_the_rows() {
        let rows: Vec<Quad> =
            (0..9).map(|i| Quad([i as f32, i as f32 + 0.25, -(i as f32), 100.0 + i as f32])).collect();
        let ids = [7, 2, 0, 5];
        let columns = F32x4::gather(&ids, |i| &rows[i as usize]);
        for (lane, id) in ids.iter().enumerate() {
            for (k, column) in columns.iter().enumerate() {
                assert_eq!(column.get(lane), rows[*id as usize].0[k]);
            }
        }
        let mut out = [Quad::default(); 9];
        F32x4::scatter(columns, &ids, |i, q| out[i as usize] = q);
        for id in ids {
            assert_eq!(out[id as usize], rows[id as usize]);
        }
    }
}
