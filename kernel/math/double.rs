//! One `f64` for each float of a lane, for values that need more precision than `f32`.

use super::num::Num;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// `f64` side by side, one for each float of a [`Lane`](super::Lane). A lane's result never depends on its
/// neighbours.
pub trait Double: Num {
    /// The same value in every lane.
    fn splat(value: f64) -> Self;
    /// The inverse of values above a bound, 0 for other values.
    fn inverse_above(self, bound: Self) -> Self;
    /// Whether the value is 0 in all lanes.
    fn is_zero(self) -> bool;
}

impl Double for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn inverse_above(self, bound: Self) -> Self {
        if self > bound { 1.0 / self } else { 0.0 }
    }
    #[inline(always)]
    fn is_zero(self) -> bool {
        self == 0.0
    }
}

/// `W` values of `f64`. The compiler keeps them in registers of the width that the entry point allows.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct Doubles<const W: usize>([f64; W]);

impl<const W: usize> Doubles<W> {
    /// Widens floats.
    #[inline(always)]
    pub(crate) fn of(values: [f32; W]) -> Self {
        let mut wide = [0.0; W];
        for i in 0..W {
            wide[i] = f64::from(values[i]);
        }
        Self(wide)
    }

    /// Rounds to floats.
    #[inline(always)]
    pub(crate) fn rounded(self) -> [f32; W] {
        let mut rounded = [0.0; W];
        for i in 0..W {
            rounded[i] = self.0[i] as f32;
        }
        rounded
    }
}

macro_rules! binary {
    ($trait:ident $method:ident) => {
        impl<const W: usize> $trait for Doubles<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for i in 0..W {
                    self.0[i] = self.0[i].$method(other.0[i]);
                }
                self
            }
        }
    };
}
binary!(Add add);
binary!(Sub sub);
binary!(Mul mul);
binary!(Div div);

impl<const W: usize> AddAssign for Doubles<W> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const W: usize> SubAssign for Doubles<W> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const W: usize> Neg for Doubles<W> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for i in 0..W {
            self.0[i] = -self.0[i];
        }
        self
    }
}

impl<const W: usize> Default for Doubles<W> {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl<const W: usize> Num for Doubles<W> {
    const ZERO: Self = Self([0.0; W]);
    const ONE: Self = Self([1.0; W]);
    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for i in 0..W {
            self.0[i] = self.0[i].sqrt();
        }
        self
    }
}

impl<const W: usize> Double for Doubles<W> {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; W])
    }
    #[inline(always)]
    fn inverse_above(mut self, bound: Self) -> Self {
        for i in 0..W {
            self.0[i] = self.0[i].inverse_above(bound.0[i]);
        }
        self
    }
    #[inline(always)]
    fn is_zero(self) -> bool {
        let mut all = true;
        for i in 0..W {
            all &= self.0[i] == 0.0;
        }
        all
    }
}
