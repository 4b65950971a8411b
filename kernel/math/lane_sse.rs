//! Four lanes on x86-64's baseline, SSE2.
#![expect(unsafe_code, reason = "SSE2 intrinsics; every x86-64 has them")]

use super::double::Doubles;
use super::lane::{Lane, Quad};
use super::num::Num;
use core::arch::x86_64::*;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Four `f32` side by side.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct F32x4(__m128);

/// A comparison of four lanes. All bits of a lane are set where it holds.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Mask4(__m128);

macro_rules! binary {
    ($trait:ident $method:ident $intrinsic:ident) => {
        impl $trait for F32x4 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: SSE2 is part of the x86-64 baseline.
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}
binary!(Add add _mm_add_ps);
binary!(Sub sub _mm_sub_ps);
binary!(Mul mul _mm_mul_ps);
binary!(Div div _mm_div_ps);

impl AddAssign for F32x4 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for F32x4 {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for F32x4 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        Self(unsafe { _mm_xor_ps(self.0, _mm_set1_ps(-0.0)) })
    }
}

impl Default for F32x4 {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl Num for F32x4 {
    // SAFETY: any 128 bits are a valid __m128.
    const ZERO: Self = Self(unsafe { core::mem::transmute::<[f32; 4], __m128>([0.0; 4]) });
    // SAFETY: any 128 bits are a valid __m128.
    const ONE: Self = Self(unsafe { core::mem::transmute::<[f32; 4], __m128>([1.0; 4]) });
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        Self(unsafe { _mm_sqrt_ps(self.0) })
    }
}

impl F32x4 {
    /// Four values side by side.
    #[inline(always)]
    pub const fn new(values: [f32; 4]) -> Self {
        // SAFETY: any 128 bits are a valid __m128.
        Self(unsafe { core::mem::transmute::<[f32; 4], __m128>(values) })
    }

    /// The lanes of some values, one after another.
    #[inline(always)]
    pub fn flat(values: &[Self]) -> &[f32] {
        // SAFETY: `Self` is four `f32` in order, without padding, and more strictly aligned.
        unsafe { core::slice::from_raw_parts(values.as_ptr().cast(), 4 * values.len()) }
    }

    #[inline(always)]
    fn array(self) -> [f32; 4] {
        // SAFETY: __m128 and [f32; 4] have the same size, and any bits are valid for both.
        unsafe { core::mem::transmute(self.0) }
    }

    #[inline(always)]
    fn from_quad(quad: &Quad) -> __m128 {
        // SAFETY: a `Quad` is 16 bytes at an address aligned to 16.
        unsafe { _mm_load_ps(quad.0.as_ptr()) }
    }
}

/// The 4 × 4 transpose: rows become columns.
#[inline(always)]
fn transpose(rows: [__m128; 4]) -> [__m128; 4] {
    let [a, b, c, d] = rows;
    // SAFETY: SSE2 is part of the x86-64 baseline.
    unsafe {
        let (ab_low, cd_low) = (_mm_unpacklo_ps(a, b), _mm_unpacklo_ps(c, d));
        let (ab_high, cd_high) = (_mm_unpackhi_ps(a, b), _mm_unpackhi_ps(c, d));
        [
            _mm_movelh_ps(ab_low, cd_low),
            _mm_movehl_ps(cd_low, ab_low),
            _mm_movelh_ps(ab_high, cd_high),
            _mm_movehl_ps(cd_high, ab_high),
        ]
    }
}

impl Lane for F32x4 {
    const WIDTH: usize = 4;
    type Mask = Mask4;
    type Ids = [u32; 4];
    type Double = Doubles<4>;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        Self(unsafe { _mm_set1_ps(value) })
    }
    #[inline(always)]
    fn get(&self, i: usize) -> f32 {
        self.array()[i]
    }
    #[inline(always)]
    fn set(&mut self, i: usize, value: f32) {
        assert!(i < 4, "a lane of four");
        // SAFETY: `Self` is four `f32` in order, and `i` is below four. A store of one float: going
        // through a copy of the register would cost a round trip for each lane written.
        unsafe { core::ptr::from_mut(self).cast::<f32>().add(i).write(value) };
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: SSE2 is part of the x86-64 baseline. MAXPS is `a > b ? a : b`.
        Self(unsafe { _mm_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: SSE2 is part of the x86-64 baseline. MINPS is `a < b ? a : b`.
        Self(unsafe { _mm_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask4 {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        Mask4(unsafe { _mm_cmplt_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask4 {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        Mask4(unsafe { _mm_cmple_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask4 {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        Mask4(unsafe { _mm_cmpeq_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn or(a: Mask4, b: Mask4) -> Mask4 {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        Mask4(unsafe { _mm_or_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn and(a: Mask4, b: Mask4) -> Mask4 {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        Mask4(unsafe { _mm_and_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn any(mask: Mask4) -> bool {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        unsafe { _mm_movemask_ps(mask.0) != 0 }
    }
    #[inline(always)]
    fn bits(mask: Mask4) -> u32 {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        unsafe { _mm_movemask_ps(mask.0) as u32 }
    }
    #[inline(always)]
    fn select(mask: Mask4, a: Self, b: Self) -> Self {
        // SAFETY: SSE2 is part of the x86-64 baseline.
        Self(unsafe { _mm_or_ps(_mm_and_ps(mask.0, a.0), _mm_andnot_ps(mask.0, b.0)) })
    }
    #[inline(always)]
    fn double(self) -> Doubles<4> {
        Doubles::of(self.array())
    }
    #[inline(always)]
    fn of_double(values: Doubles<4>) -> Self {
        Self::new(values.rounded())
    }
    #[inline(always)]
    fn gather<'a>(ids: &[u32; 4], fetch: impl Fn(u32) -> &'a Quad) -> [Self; 4] {
        transpose([
            Self::from_quad(fetch(ids[0])),
            Self::from_quad(fetch(ids[1])),
            Self::from_quad(fetch(ids[2])),
            Self::from_quad(fetch(ids[3])),
        ])
        .map(Self)
    }
    #[inline(always)]
    fn scatter(values: [Self; 4], ids: &[u32; 4], mut put: impl FnMut(u32, Quad)) {
        let rows = transpose(values.map(|v| v.0));
        put(ids[0], Quad(Self(rows[0]).array()));
        put(ids[1], Quad(Self(rows[1]).array()));
        put(ids[2], Quad(Self(rows[2]).array()));
        put(ids[3], Quad(Self(rows[3]).array()));
    }
}
