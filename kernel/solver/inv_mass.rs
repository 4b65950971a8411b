//! The inverse mass of a row's body: one number, or one per axis.

use crate::math::{Lane, Num, Vector};

/// The velocity change per impulse. Rows of bodies with locked axes have an inverse mass per world axis,
/// all others have one number.
pub trait InvMass<N: Lane>: Copy + Send + Sync {
    /// Immovable.
    const ZERO: Self;
    /// The velocity change by an impulse.
    fn apply(self, impulse: Vector<N>) -> Vector<N>;
    /// The inverse mass along each world axis.
    fn diagonal(self) -> Vector<N>;
    /// The inverse mass along a unit vector.
    fn along(self, n: Vector<N>) -> N;
    /// Whether no impulse moves the body.
    fn is_zero(self) -> N::Mask;
    /// From the inverse mass, and factors that are 1 along free axes and 0 along locked ones.
    fn new(inv_mass: N, free: Vector<N>) -> Self;
}

impl<N: Lane> InvMass<N> for N {
    const ZERO: Self = <N as Num>::ZERO;
    #[inline(always)]
    fn apply(self, impulse: Vector<N>) -> Vector<N> {
        impulse * self
    }
    #[inline(always)]
    fn diagonal(self) -> Vector<N> {
        Vector::splat(Vector::ONE) * self
    }
    #[inline(always)]
    fn along(self, _: Vector<N>) -> N {
        self
    }
    #[inline(always)]
    fn is_zero(self) -> N::Mask {
        self.eq(<N as Num>::ZERO)
    }
    #[inline(always)]
    fn new(inv_mass: N, _free: Vector<N>) -> Self {
        inv_mass
    }
}

impl<N: Lane> InvMass<N> for Vector<N> {
    const ZERO: Self = Vector::ZERO;
    #[inline(always)]
    fn apply(self, impulse: Vector<N>) -> Vector<N> {
        impulse.scale(self)
    }
    #[inline(always)]
    fn diagonal(self) -> Vector<N> {
        self
    }
    #[inline(always)]
    fn along(self, n: Vector<N>) -> N {
        n.dot(n.scale(self))
    }
    #[inline(always)]
    fn is_zero(self) -> N::Mask {
        self.dot(self).eq(<N as Num>::ZERO)
    }
    #[inline(always)]
    fn new(inv_mass: N, free: Vector<N>) -> Self {
        free * inv_mass
    }
}
