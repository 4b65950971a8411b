//! Eight lanes on x86-64 with AVX2, chosen at run time.
//!
//! The operations need AVX2, but the traits of lanes have no target feature. So the type is private to the
//! crate, and only entry points with the feature `avx2` use it. All methods are inlined into these entry
//! points, and their callers have an [`Avx2`](super::Avx2). `tests/rules.rs` lists the files that may name
//! the type. Each operation gives the same bits as the four-lane type.
#![expect(unsafe_code, reason = "AVX intrinsics; lanes of this width are only used where the CPU has them")]

use super::double::Doubles;
use super::lane::{Lane, Quad};
use super::num::Num;
use core::arch::x86_64::*;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Eight `f32` side by side.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct F32x8(__m256);

/// A comparison of eight lanes. All bits of a lane are set where it holds.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct Mask8(__m256);

macro_rules! binary {
    ($trait:ident $method:ident $intrinsic:ident) => {
        impl $trait for F32x8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: below an entry point that has an `Avx2` (see the module).
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}
binary!(Add add _mm256_add_ps);
binary!(Sub sub _mm256_sub_ps);
binary!(Mul mul _mm256_mul_ps);
binary!(Div div _mm256_div_ps);

impl AddAssign for F32x8 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for F32x8 {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for F32x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        Self(unsafe { _mm256_xor_ps(self.0, _mm256_set1_ps(-0.0)) })
    }
}

impl Default for F32x8 {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl Num for F32x8 {
    // SAFETY: any 256 bits are a valid __m256.
    const ZERO: Self = Self(unsafe { core::mem::transmute::<[f32; 8], __m256>([0.0; 8]) });
    // SAFETY: any 256 bits are a valid __m256.
    const ONE: Self = Self(unsafe { core::mem::transmute::<[f32; 8], __m256>([1.0; 8]) });
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        Self(unsafe { _mm256_sqrt_ps(self.0) })
    }
}

impl F32x8 {
    #[inline(always)]
    fn array(self) -> [f32; 8] {
        // SAFETY: __m256 and [f32; 8] have the same size, and any bits are valid for both.
        unsafe { core::mem::transmute(self.0) }
    }

    #[inline(always)]
    fn of_array(values: [f32; 8]) -> Self {
        // SAFETY: as above.
        Self(unsafe { core::mem::transmute::<[f32; 8], __m256>(values) })
    }
}

/// The 4 × 4 transpose in both halves: rows become columns.
#[inline(always)]
fn transpose(rows: [__m256; 4]) -> [__m256; 4] {
    let [a, b, c, d] = rows;
    // SAFETY: below an entry point that has an `Avx2` (see the module).
    unsafe {
        let (ab_low, cd_low) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
        let (ab_high, cd_high) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
        [
            _mm256_shuffle_ps::<0x44>(ab_low, cd_low),
            _mm256_shuffle_ps::<0xEE>(ab_low, cd_low),
            _mm256_shuffle_ps::<0x44>(ab_high, cd_high),
            _mm256_shuffle_ps::<0xEE>(ab_high, cd_high),
        ]
    }
}

/// Two quads as the halves of one register.
#[inline(always)]
fn join(low: &Quad, high: &Quad) -> __m256 {
    // SAFETY: a `Quad` is 16 bytes at an address aligned to 16; below an entry point that has an `Avx2` (see
    // the module).
    unsafe {
        let low = _mm256_castps128_ps256(_mm_load_ps(low.0.as_ptr()));
        _mm256_insertf128_ps::<1>(low, _mm_load_ps(high.0.as_ptr()))
    }
}

/// The halves of a register as two quads.
#[inline(always)]
fn split(v: __m256) -> [Quad; 2] {
    // SAFETY: a register is as large as two quads, and any bits are valid for both.
    unsafe { core::mem::transmute(v) }
}

impl Lane for F32x8 {
    const WIDTH: usize = 8;
    type Mask = Mask8;
    type Ids = [u32; 8];
    type Double = Doubles<8>;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        Self(unsafe { _mm256_set1_ps(value) })
    }
    #[inline(always)]
    fn get(&self, i: usize) -> f32 {
        self.array()[i]
    }
    #[inline(always)]
    fn set(&mut self, i: usize, value: f32) {
        assert!(i < 8, "a lane of eight");
        // SAFETY: `Self` is eight `f32` in order, and `i` is below eight. A store of one float: going
        // through a copy of the register would cost a round trip for each lane written.
        unsafe { core::ptr::from_mut(self).cast::<f32>().add(i).write(value) };
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: below an entry point that has an `Avx2` (see the module). MAXPS is `a > b ? a : b`.
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: below an entry point that has an `Avx2` (see the module). MINPS is `a < b ? a : b`.
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask8 {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        Mask8(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask8 {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        Mask8(unsafe { _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask8 {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        Mask8(unsafe { _mm256_cmp_ps::<_CMP_EQ_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn or(a: Mask8, b: Mask8) -> Mask8 {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        Mask8(unsafe { _mm256_or_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn and(a: Mask8, b: Mask8) -> Mask8 {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        Mask8(unsafe { _mm256_and_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn any(mask: Mask8) -> bool {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        unsafe { _mm256_movemask_ps(mask.0) != 0 }
    }
    #[inline(always)]
    fn bits(mask: Mask8) -> u32 {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        unsafe { _mm256_movemask_ps(mask.0) as u32 }
    }
    #[inline(always)]
    fn select(mask: Mask8, a: Self, b: Self) -> Self {
        // SAFETY: below an entry point that has an `Avx2` (see the module).
        Self(unsafe { _mm256_blendv_ps(b.0, a.0, mask.0) })
    }
    #[inline(always)]
    fn double(self) -> Doubles<8> {
        Doubles::of(self.array())
    }
    #[inline(always)]
    fn of_double(values: Doubles<8>) -> Self {
        Self::of_array(values.rounded())
    }
    #[inline(always)]
    fn gather<'a>(ids: &[u32; 8], fetch: impl Fn(u32) -> &'a Quad) -> [Self; 4] {
        transpose([
            join(fetch(ids[0]), fetch(ids[4])),
            join(fetch(ids[1]), fetch(ids[5])),
            join(fetch(ids[2]), fetch(ids[6])),
            join(fetch(ids[3]), fetch(ids[7])),
        ])
        .map(Self)
    }
    #[inline(always)]
    fn scatter(values: [Self; 4], ids: &[u32; 8], mut put: impl FnMut(u32, Quad)) {
        let [a, b, c, d] = transpose(values.map(|v| v.0)).map(split);
        put(ids[0], a[0]);
        put(ids[1], b[0]);
        put(ids[2], c[0]);
        put(ids[3], d[0]);
        put(ids[4], a[1]);
        put(ids[5], b[1]);
        put(ids[6], c[1]);
        put(ids[7], d[1]);
    }
}
