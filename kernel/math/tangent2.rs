//! The tangent space of a contact in the plane: its direction, and the effective mass along it. `tangent3.rs`
//! has the same types with the same operations.

use super::{InvInertia, Lane, Num, Vector};

/// A vector in the tangent space of a contact: one number along the tangent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Tangent<N = f32> {
    /// Along the tangent.
    pub x: N,
}

/// The tangent directions of a contact normal.
#[derive(Clone, Copy, Debug)]
pub struct TangentFrame<N = f32> {
    x: Vector<N>,
}

/// The effective mass of a contact's tangent row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct TangentMass<N = f32> {
    xx: N,
}

/// An angular impulse about the normal of a contact. In 2D there is none, and the type takes no bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NormalMoment;

impl NormalMoment {
    /// Ignores the impulse in 2D.
    #[inline(always)]
    pub fn new(_impulse: f32) -> Self {
        Self
    }
    /// 0 in 2D.
    #[inline(always)]
    pub fn get(self) -> f32 {
        0.0
    }
}

impl Vector {
    /// A unit vector at right angles to this unit vector.
    #[inline]
    pub fn any_orthonormal(self) -> Self {
        self.perp()
    }
}

impl<N: Num> Tangent<N> {
    /// The zero vector.
    pub const ZERO: Self = Self { x: N::ZERO };
}

impl<N: Lane> Tangent<N> {
    /// Shortened to at most `limit` (≥ 0).
    #[inline(always)]
    pub fn clamp_length(self, limit: N) -> Self {
        Self { x: self.x.max(-limit).min(limit) }
    }
    /// The magnitude.
    #[inline(always)]
    pub fn length(self) -> N {
        self.x.max(-self.x)
    }
    /// Writes lane `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: Tangent) {
        self.x.set(i, v.x);
    }
    /// Reads lane `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Tangent {
        Tangent { x: self.x.get(i) }
    }
}

impl<N: Lane> TangentFrame<N> {
    /// The tangent of a unit normal: the normal turned clockwise by a quarter.
    #[inline(always)]
    pub fn new(normal: Vector<N>) -> Self {
        Self { x: Vector { x: normal.y, y: -normal.x } }
    }
    /// The part of `v` in the tangent space.
    #[inline(always)]
    pub fn project(&self, v: Vector<N>) -> Tangent<N> {
        Tangent { x: self.x.dot(v) }
    }
    /// The vector that a tangent-space vector stands for.
    #[inline(always)]
    pub fn expand(&self, t: Tangent<N>) -> Vector<N> {
        self.x * t.x
    }
    /// The inverse of the tangent row's K for two bodies with the given inverse inertias and arms: K = tᵀ M⁻¹
    /// t + Σ (rᵢ × t)ᵀ Iᵢ⁻¹ (rᵢ × t), where `inv_mass` is the diagonal of the summed M⁻¹. Zero where K is
    /// zero.
    #[inline(always)]
    pub fn mass(&self, inv_mass: Vector<N>, bodies: [(InvInertia<N>, Vector<N>); 2]) -> TangentMass<N> {
        let mut k = self.x.dot(self.x.scale(inv_mass));
        for (inertia, arm) in bodies {
            let c = arm.cross(self.x);
            k += c.dot(inertia.apply(c));
        }
        TangentMass { xx: N::select(N::ZERO.lt(k), N::ONE / k, N::ZERO) }
    }
}

impl<N: Lane> TangentMass<N> {
    /// The new total friction impulse, given the total `impulse` so far and the slip velocity `v`: the
    /// impulse that stops the slip if it is within `limit`, otherwise an impulse of that length against the
    /// slip.
    #[inline(always)]
    pub fn solve_coulomb(self, impulse: Tangent<N>, v: Tangent<N>, limit: N) -> Tangent<N> {
        (impulse - self.apply(v)).clamp_length(limit)
    }
    /// The change of slip per impulse, 1/kg; 0 if nothing moves.
    #[inline(always)]
    pub fn mean_inverse(self) -> N {
        N::select(N::ZERO.lt(self.xx), N::ONE / self.xx, N::ZERO)
    }
}

impl<N: Num> TangentMass<N> {
    /// Minus the impulse that stops the tangent velocity `v`.
    #[inline(always)]
    pub fn apply(self, v: Tangent<N>) -> Tangent<N> {
        Tangent { x: self.xx * v.x }
    }
}

componentwise! { Tangent { x } }
