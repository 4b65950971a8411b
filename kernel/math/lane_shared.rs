//! Lanes of rows in which a body may be in several lanes.

use super::lane::{Lane, Quad};
use super::num::Num;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Lanes of `N`, for rows that [share](Lane::SHARES) bodies. Computes as `N` does.
#[derive(Clone, Copy, Debug, Default)]
#[repr(transparent)]
pub struct Shared<N>(N);

macro_rules! binary {
    ($trait:ident $method:ident) => {
        impl<N: Lane> $trait for Shared<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    };
}
binary!(Add add);
binary!(Sub sub);
binary!(Mul mul);
binary!(Div div);

impl<N: Lane> AddAssign for Shared<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl<N: Lane> SubAssign for Shared<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.0 -= other.0;
    }
}

impl<N: Lane> Neg for Shared<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<N: Lane> Num for Shared<N> {
    const ZERO: Self = Self(N::ZERO);
    const ONE: Self = Self(N::ONE);
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
}

impl<N: Lane> Lane for Shared<N> {
    const WIDTH: usize = N::WIDTH;
    const SHARES: bool = true;
    type Mask = N::Mask;
    type Ids = N::Ids;
    type Double = N::Double;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(N::splat(value))
    }
    #[inline(always)]
    fn get(&self, i: usize) -> f32 {
        self.0.get(i)
    }
    #[inline(always)]
    fn set(&mut self, i: usize, value: f32) {
        self.0.set(i, value);
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> N::Mask {
        self.0.lt(other.0)
    }
    #[inline(always)]
    fn le(self, other: Self) -> N::Mask {
        self.0.le(other.0)
    }
    #[inline(always)]
    fn eq(self, other: Self) -> N::Mask {
        self.0.eq(other.0)
    }
    #[inline(always)]
    fn or(a: N::Mask, b: N::Mask) -> N::Mask {
        N::or(a, b)
    }
    #[inline(always)]
    fn and(a: N::Mask, b: N::Mask) -> N::Mask {
        N::and(a, b)
    }
    #[inline(always)]
    fn any(mask: N::Mask) -> bool {
        N::any(mask)
    }
    #[inline(always)]
    fn bits(mask: N::Mask) -> u32 {
        N::bits(mask)
    }
    #[inline(always)]
    fn select(mask: N::Mask, a: Self, b: Self) -> Self {
        Self(N::select(mask, a.0, b.0))
    }
    #[inline(always)]
    fn double(self) -> N::Double {
        self.0.double()
    }
    #[inline(always)]
    fn of_double(values: N::Double) -> Self {
        Self(N::of_double(values))
    }
    #[inline(always)]
    fn gather<'a>(ids: &N::Ids, fetch: impl Fn(u32) -> &'a Quad) -> [Self; 4] {
        N::gather(ids, fetch).map(Self)
    }
    #[inline(always)]
    fn scatter(values: [Self; 4], ids: &N::Ids, put: impl FnMut(u32, Quad)) {
        N::scatter(values.map(|value| value.0), ids, put);
    }
}
