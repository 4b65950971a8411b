//! Four lanes as plain arrays, for targets without their own implementation.
#![expect(unsafe_code, reason = "lanes are looked at one by one")]

use super::double::Doubles;
use super::lane::{Lane, Quad};
use super::num::Num;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Four `f32` side by side.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
pub struct F32x4([f32; 4]);

macro_rules! binary {
    ($trait:ident $method:ident $op:tt) => {
        impl $trait for F32x4 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(core::array::from_fn(|i| self.0[i] $op other.0[i]))
            }
        }
    };
}
binary!(Add add +);
binary!(Sub sub -);
binary!(Mul mul *);
binary!(Div div /);

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

impl F32x4 {
    /// Four values side by side.
    #[inline(always)]
    pub const fn new(values: [f32; 4]) -> Self {
        Self(values)
    }

    /// The lanes of some values, one after another.
    #[inline(always)]
    pub fn flat(values: &[Self]) -> &[f32] {
        // SAFETY: `Self` is four `f32` in order, without padding, and more strictly aligned.
        unsafe { core::slice::from_raw_parts(values.as_ptr().cast(), 4 * values.len()) }
    }
}

impl Neg for F32x4 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|v| -v))
    }
}

impl Num for F32x4 {
    const ZERO: Self = Self([0.0; 4]);
    const ONE: Self = Self([1.0; 4]);
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f32::sqrt))
    }
}

impl Lane for F32x4 {
    const WIDTH: usize = 4;
    type Mask = [bool; 4];
    type Ids = [u32; 4];
    type Double = Doubles<4>;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; 4])
    }
    #[inline(always)]
    fn get(&self, i: usize) -> f32 {
        self.0[i]
    }
    #[inline(always)]
    fn set(&mut self, i: usize, value: f32) {
        self.0[i] = value;
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| super::max(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| super::min(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> [bool; 4] {
        core::array::from_fn(|i| self.0[i] < other.0[i])
    }
    #[inline(always)]
    fn le(self, other: Self) -> [bool; 4] {
        core::array::from_fn(|i| self.0[i] <= other.0[i])
    }
    #[inline(always)]
    fn eq(self, other: Self) -> [bool; 4] {
        core::array::from_fn(|i| self.0[i] == other.0[i])
    }
    #[inline(always)]
    fn or(a: [bool; 4], b: [bool; 4]) -> [bool; 4] {
        core::array::from_fn(|i| a[i] | b[i])
    }
    #[inline(always)]
    fn and(a: [bool; 4], b: [bool; 4]) -> [bool; 4] {
        core::array::from_fn(|i| a[i] & b[i])
    }
    #[inline(always)]
    fn any(mask: [bool; 4]) -> bool {
        mask[0] | mask[1] | mask[2] | mask[3]
    }
    #[inline(always)]
    fn bits(mask: [bool; 4]) -> u32 {
        (0..4).fold(0, |bits, i| bits | u32::from(mask[i]) << i)
    }
    #[inline(always)]
    fn select(mask: [bool; 4], a: Self, b: Self) -> Self {
        Self(core::array::from_fn(|i| if mask[i] { a.0[i] } else { b.0[i] }))
    }
    #[inline(always)]
    fn double(self) -> Doubles<4> {
        Doubles::of(self.0)
    }
    #[inline(always)]
    fn of_double(values: Doubles<4>) -> Self {
        Self(values.rounded())
    }
    #[inline(always)]
    fn gather<'a>(ids: &[u32; 4], fetch: impl Fn(u32) -> &'a Quad) -> [Self; 4] {
        let rows = ids.map(|id| fetch(id).0);
        core::array::from_fn(|k| Self(core::array::from_fn(|i| rows[i][k])))
    }
    #[inline(always)]
    fn scatter(values: [Self; 4], ids: &[u32; 4], mut put: impl FnMut(u32, Quad)) {
        for i in 0..4 {
            put(ids[i], Quad(core::array::from_fn(|k| values[k].0[i])));
        }
    }
}
