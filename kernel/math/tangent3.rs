//! The tangent space of a contact in space: its directions, and the effective mass along them. `tangent2.rs`
//! has the same types with the same operations.

use super::{InvInertia, Lane, Num, Vector};

/// A vector in the tangent plane of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Tangent<N = f32> {
    /// Along the first tangent.
    pub x: N,
    /// Along the second tangent.
    pub y: N,
}

/// The tangent directions of a contact normal.
#[derive(Clone, Copy, Debug)]
pub struct TangentFrame<N = f32> {
    x: Vector<N>,
    y: Vector<N>,
}

/// The effective mass of a contact's coupled tangent rows, a symmetric 2 × 2 matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct TangentMass<N = f32> {
    xx: N,
    yy: N,
    xy: N,
}

/// An angular impulse about the normal of a contact, N·m·s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NormalMoment(f32);

impl NormalMoment {
    /// An angular impulse, N·m·s.
    #[inline(always)]
    pub fn new(impulse: f32) -> Self {
        Self(impulse)
    }
    /// The angular impulse, N·m·s.
    #[inline(always)]
    pub fn get(self) -> f32 {
        self.0
    }
}

impl Vector {
    /// A unit vector at right angles to this unit vector.
    #[inline]
    pub fn any_orthonormal(self) -> Self {
        TangentFrame::new(self).x
    }
}

impl<N: Num> Tangent<N> {
    /// The zero vector.
    pub const ZERO: Self = Self { x: N::ZERO, y: N::ZERO };
}

impl<N: Lane> Tangent<N> {
    /// Shortened to at most `limit` (≥ 0), along its direction: a circular cone.
    #[inline(always)]
    pub fn clamp_length(self, limit: N) -> Self {
        let square = self.x * self.x + self.y * self.y;
        let long = (limit * limit).lt(square);
        let factor = N::select(long, limit / square.sqrt(), N::ONE);
        Self { x: self.x * factor, y: self.y * factor }
    }
    /// The magnitude.
    #[inline(always)]
    pub fn length(self) -> N {
        (self.x * self.x + self.y * self.y).sqrt()
    }
    /// Writes lane `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: Tangent) {
        self.x.set(i, v.x);
        self.y.set(i, v.y);
    }
    /// Reads lane `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Tangent {
        Tangent { x: self.x.get(i), y: self.y.get(i) }
    }
}

/// A symmetric 2 × 2 matrix counts as singular if its determinant is below this share of its squared trace:
/// below it the determinant is rounding.
const SINGULAR: f32 = 1.0e-5;

impl<N: Lane> TangentFrame<N> {
    /// Two unit tangents of a unit normal, without a branch (Duff et al., "Building an Orthonormal
    /// Basis, Revisited", JCGT 2017).
    #[inline(always)]
    pub fn new(n: Vector<N>) -> Self {
        let sign = N::select(n.z.lt(N::ZERO), -N::ONE, N::ONE);
        let a = -N::ONE / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            x: Vector { x: N::ONE + sign * n.x * n.x * a, y: sign * b, z: -(sign * n.x) },
            y: Vector { x: b, y: sign + n.y * n.y * a, z: -n.y },
        }
    }
    /// The part of `v` in the tangent plane.
    #[inline(always)]
    pub fn project(&self, v: Vector<N>) -> Tangent<N> {
        Tangent { x: self.x.dot(v), y: self.y.dot(v) }
    }
    /// The vector that a tangent-plane vector stands for.
    #[inline(always)]
    pub fn expand(&self, t: Tangent<N>) -> Vector<N> {
        self.x * t.x + self.y * t.y
    }
    /// The inverse of the coupled tangent rows' 2 × 2 K matrix for two bodies with the given inverse inertias
    /// and arms: K_ab = t_aᵀ M⁻¹ t_b + Σ (rᵢ × t_a)ᵀ Iᵢ⁻¹ (rᵢ × t_b), where `inv_mass` is the diagonal of the
    /// summed M⁻¹. If K has rank one, as between bodies locked to a plane, it is the inverse along the only
    /// direction; zero if K is zero.
    #[inline(always)]
    pub fn mass(&self, inv_mass: Vector<N>, bodies: [(InvInertia<N>, Vector<N>); 2]) -> TangentMass<N> {
        let (lx, ly) = (self.x.scale(inv_mass), self.y.scale(inv_mass));
        let (mut xx, mut yy, mut xy) = (self.x.dot(lx), self.y.dot(ly), self.x.dot(ly));
        for (inertia, arm) in bodies {
            let (cx, cy) = (arm.cross(self.x), arm.cross(self.y));
            let (ix, iy) = (inertia.apply(cx), inertia.apply(cy));
            xx += cx.dot(ix);
            yy += cy.dot(iy);
            xy += cx.dot(iy);
        }
        let (determinant, trace) = (xx * yy - xy * xy, xx + yy);
        let regular = (trace * trace * N::splat(SINGULAR)).lt(determinant);
        let k = N::ONE / N::select(regular, determinant, trace * trace);
        let k = N::select(N::ZERO.lt(trace), k, N::ZERO);
        let [xx, yy, xy] =
            [(yy, xx), (xx, yy), (-xy, xy)].map(|(inverse, own)| N::select(regular, inverse, own) * k);
        TangentMass { xx, yy, xy }
    }
}

impl<N: Lane> TangentMass<N> {
    /// The new total friction impulse, given the total `impulse` so far and the slip velocity `v`, at most
    /// `limit` long: the impulse that stops the slip if that is allowed, otherwise an impulse against the
    /// slip.
    ///
    /// Let u be the slip without `impulse`. The impulse that stops it, λ = −M u, is not along u if bodies
    /// turn more easily about one axis than about another. So an impulse beyond the limit is replaced by an
    /// impulse against u, no longer than the impulse that stops the slip along u: |u| / (û · M⁻¹ û). It never
    /// gains energy. Everything is computed from w = A λ, which is against u, where A is adj(M) divided by
    /// the trace of M, so w is about as large as λ.
    #[inline(always)]
    pub fn solve_coulomb(self, impulse: Tangent<N>, v: Tangent<N>, limit: N) -> Tangent<N> {
        let stick = impulse - self.apply(v);
        let slides = (limit * limit).lt(stick.x * stick.x + stick.y * stick.y);
        let tiny = N::splat(f32::MIN_POSITIVE);
        let share = N::ONE / (self.xx + self.yy).max(tiny);
        let adjugate = Self { xx: self.yy * share, yy: self.xx * share, xy: -self.xy * share };
        let determinant = adjugate.xx * adjugate.yy - adjugate.xy * adjugate.xy;
        let regular = N::splat(SINGULAR).lt(determinant);
        let against = adjugate.apply(stick);
        let bent = adjugate.apply(against);
        let square = against.x * against.x + against.y * against.y;
        let along = against.x * bent.x + against.y * bent.y;
        // Lengths are divided by the length of w: |w|³ / (w · A w) is the length that stops the slip.
        let factor = (limit / square.sqrt().max(tiny)).min(square / along.max(tiny));
        let slide = Tangent::select(regular, against * factor, stick.clamp_length(limit));
        Tangent::select(slides, slide, stick)
    }
    /// The approximate change of slip per impulse, 1/kg; it differs between the tangents. 0 if nothing moves.
    #[inline(always)]
    pub fn mean_inverse(self) -> N {
        let sum = self.xx + self.yy;
        N::select(N::ZERO.lt(sum), N::splat(2.0) / sum, N::ZERO)
    }
    /// The slip that an impulse stops.
    #[inline(always)]
    pub fn slip(self, impulse: Tangent<N>) -> Tangent<N> {
        let (determinant, trace) = (self.xx * self.yy - self.xy * self.xy, self.xx + self.yy);
        let regular = (trace * trace * N::splat(SINGULAR)).lt(determinant);
        let adjugate = Self { xx: self.yy, yy: self.xx, xy: -self.xy };
        let slip = adjugate.apply(impulse) * (N::ONE / determinant);
        Tangent::select(regular, slip, impulse * (N::ONE / trace.max(N::splat(f32::MIN_POSITIVE))))
    }
}

impl<N: Num> TangentMass<N> {
    /// Minus the impulse that stops the tangent velocity `v`.
    #[inline(always)]
    pub fn apply(self, v: Tangent<N>) -> Tangent<N> {
        Tangent { x: self.xx * v.x + self.xy * v.y, y: self.xy * v.x + self.yy * v.y }
    }
}

componentwise! { Tangent { x, y } }

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn length(t: [f64; 2]) -> f64 {
        t[0].hypot(t[1])
    }

    proptest! {
        /// Compares with the closed form in f64, for masses from a speck to a planet.
        #[test]
        fn friction_is_against_the_slip_and_gains_no_energy(
            (a, b, turn) in (0.1f64..10.0, 0.1f64..10.0, 0.0f64..3.2),
            slip in [-3.0f64..3.0, -3.0f64..3.0], limit in 0.0f64..3.0, scale in -9i32..12,
        ) {
            // The masses a and b along two axes, and the mass matrix of a slip along x and y.
            let scale = 10.0f64.powi(scale);
            let (sin, cos) = turn.sin_cos();
            let (xx, yy, xy) = (a * cos * cos + b * sin * sin, a * sin * sin + b * cos * cos, (a - b) * sin * cos);
            let lane = |x: f64| x as f32;
            let mass = TangentMass { xx: lane(xx * scale), yy: lane(yy * scale), xy: lane(xy * scale) };
            let u = Tangent { x: lane(slip[0]), y: lane(slip[1]) };
            let found = mass.solve_coulomb(Tangent::ZERO, u, lane(limit * scale));
            let found = [found.x, found.y].map(|lane| f64::from(lane) / scale);
            let stop = [-(xx * slip[0] + xy * slip[1]), -(xy * slip[0] + yy * slip[1])];
            if length(stop) <= limit {
                prop_assert!(length([found[0] - stop[0], found[1] - stop[1]]) < 1e-5 * (1.0 + length(stop)));
                return Ok(());
            }
            prop_assert!(length(found) <= limit * (1.0 + 1e-5));
            let (dot, across) =
                (found[0] * slip[0] + found[1] * slip[1], found[0] * slip[1] - found[1] * slip[0]);
            prop_assert!(dot <= 0.0 && across.abs() <= 1e-3 * length(found) * length(slip), "{found:?} for {slip:?}");
            // The gained energy: the impulse times the mean of the slips before and after.
            let determinant = a * b;
            let after = [(yy * found[0] - xy * found[1]) / determinant, (xx * found[1] - xy * found[0]) / determinant];
            let gained = dot + 0.5 * (found[0] * after[0] + found[1] * after[1]);
            prop_assert!(gained <= 1e-5 * dot.abs(), "{gained} J");
            // The impulse is as long as allowed.
            let stops = length(slip) * length(slip) * length(slip) * determinant
                / (slip[0] * (yy * slip[0] - xy * slip[1]) + slip[1] * (xx * slip[1] - xy * slip[0]));
            prop_assert!((length(found) - limit.min(stops)).abs() < 1e-3 * limit.min(stops));
        }
    }
}
