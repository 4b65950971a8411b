//! Gyroscopic torque, which conserves the angular momentum of spinning bodies with unequal moments.
//! `gyro2.rs` exports the same names.

use crate::math::{Angular, InvInertia, Lane, MAX_RATIO, Rot, SymTensor, Vector};
use crate::tuning::solver::{CONVERGED, FAR_TURN, MIN_TURN, SMALL_TURN};
use crate::tuning::sweeps::MOST_TURN;

/// Inertia of a body in its own frame, for free spin; with wide lanes, one body per lane.
///
/// Scaled so that the largest moment is about 1. Free spin does not depend on the scale, and determinants
/// of tiny bodies' tensors would underflow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gyro<N = f32> {
    pub(super) inertia: SymTensor<N>,
    pub(super) inv_inertia: SymTensor<N>,
}

/// Minimum of 1 + cos θ for which the swing by θ follows from the two directions of the axis. Below it,
/// rounding dominates.
const MIN_SWING: f32 = 1.0e-3;

impl Gyro {
    /// `None` if the three moments are equal (within 1 ‰) and the tensor is diagonal, so that ω × I ω
    /// vanishes, or if the body cannot turn about some axis.
    pub(super) fn of(inv_inertia: InvInertia) -> Option<Self> {
        let i = inv_inertia;
        let size = i.xx.abs();
        let near = |a: f32| a.abs() <= 1.0e-3 * size;
        if near(i.yy - i.xx) && near(i.zz - i.xx) && near(i.xy) && near(i.xz) && near(i.yz) {
            return None;
        }
        let i = i.blunted(MAX_RATIO);
        let inertia = i.inverse();
        let size = Vector { x: inertia.xx, y: inertia.yy, z: inertia.zz }.max_element();
        if !(size > 0.0 && (1.0 / size).is_finite()) {
            return None;
        }
        Some(Self { inertia: inertia.scaled(1.0 / size), inv_inertia: i.scaled(size) })
    }

    /// Whether a body rotates so far in a substep of `h` seconds that constraints need a correction (see
    /// `FastTurn`).
    pub(super) fn turns_far(&self, w: Angular, h: f32) -> bool {
        let square = w.length_squared() * h * h;
        square * MAX_RATIO > FAR_TURN && square * self.inv_inertia.needle_ratio() > FAR_TURN
    }

    /// The axis of the smallest moment of a body with this rotation, in world axes. If two moments are
    /// equal, either axis.
    pub(super) fn thin_axis(&self, rotation: Rot) -> Angular {
        rotation.rotate(self.inv_inertia.thin_axis())
    }

    /// The rotational energy, in a unit that depends on the body.
    pub(super) fn energy(&self, rotation: Rot, w: Angular) -> f32 {
        let local = rotation.inverse_rotate(w);
        local.dot(self.inertia.apply(local))
    }
}

impl<N: Lane> Gyro<N> {
    /// The angular velocity in the middle and at the end of `h` seconds of free spin, all in the body's
    /// frame.
    ///
    /// Euler's equation I ω̇ = −ω × I ω by the implicit midpoint rule:
    ///
    /// I (ω' − ω) + h m × I m = 0, with m = (ω + ω') / 2.
    ///
    /// Multiplied by m it gives ω' · I ω' = ω · I ω, multiplied by I m it gives |I ω'| = |I ω|: the rule
    /// conserves energy and the length of the angular momentum at any step length (Hairer, Lubich and
    /// Wanner, "Geometric Numerical Integration", IV.2.1: quadratic invariants). Implicit Euler (Catto,
    /// "Numerical Methods", GDC 2015) loses both at the rate h |ω|². A body that turns by h m keeps the
    /// direction of the momentum to third order in h.
    ///
    /// In m it reads I (m − ω) + ½ h m × I m = 0. Newton's method solves it from the explicit guess m = ω −
    /// ½ h I⁻¹ (ω × I ω), with the Jacobian I + ½ h ([m]× I − [I m]×). The remaining difference between |I
    /// ω'| and |I ω| is scaled away.
    #[inline(always)]
    pub(super) fn spun(&self, w: Angular<N>, h: N) -> (Angular<N>, Angular<N>) {
        let turn = w.length() * h;
        let rests = N::lt(turn, N::splat(MIN_TURN));
        if N::bits(rests) == (1 << N::WIDTH) - 1 {
            return (w, w);
        }
        let half = N::splat(0.5) * h;
        let k = N::select(N::lt(N::splat(MOST_TURN), turn), half * (N::splat(MOST_TURN) / turn), half);
        let momentum = self.inertia.apply(w);
        let guess = self.inv_inertia.apply(w.cross(momentum)) * -k;
        let mut middle = self.newton(w, w + guess, k);
        let far = N::lt(N::splat(SMALL_TURN), turn);
        if N::any(far) {
            let nearer = self.newton(w, self.newton(w, middle, k), k);
            middle = select(far, nearer, middle);
        }
        let change = self.kept(w, momentum, (middle - w) * N::splat(2.0));
        (select(rests, w, w + change * N::splat(0.5)), select(rests, w, w + change))
    }

    /// One Newton step for the midpoint velocity `m`.
    #[inline(always)]
    fn newton(&self, local: Vector<N>, m: Vector<N>, k: N) -> Vector<N> {
        let momentum = self.inertia.apply(m);
        let residual = self.inertia.apply(m - local) + m.cross(momentum) * k;
        // The columns of I and of [I m]×; together they give the columns of the Jacobian.
        let SymTensor { xx, yy, zz, xy, xz, yz } = self.inertia;
        let Vector { x: p, y: q, z: r } = momentum;
        let column = |along: Vector<N>, across: Vector<N>| along + (m.cross(along) - across) * k;
        let x = column(Vector { x: xx, y: xy, z: xz }, Vector { x: N::ZERO, y: r, z: -q });
        let y = column(Vector { x: xy, y: yy, z: yz }, Vector { x: -r, y: N::ZERO, z: p });
        let z = column(Vector { x: xz, y: yz, z: zz }, Vector { x: q, y: -p, z: N::ZERO });
        let (yz, determinant) = (y.cross(z), x.dot(y.cross(z)));
        // Cramer's rule for J δ = residual.
        let change = Vector { x: residual.dot(yz), y: x.dot(residual.cross(z)), z: x.dot(y.cross(residual)) };
        m - change * (N::ONE / determinant)
    }

    /// The velocity change, scaled so that the momentum keeps its length. Zero if the energy is not
    /// conserved, or if a singular Jacobian gave NaN.
    #[inline(always)]
    fn kept(&self, local: Vector<N>, momentum: Vector<N>, change: Vector<N>) -> Vector<N> {
        let gained = self.inertia.apply(change);
        let after = momentum + gained;
        let square = after.length_squared();
        // |M|² − |M'|², without the cancellation of two squares.
        let excess = gained.dot(momentum + after);
        // s − 1 = |M| / |M'| − 1 by (1 + e)^½. A better Newton step leaves a smaller e.
        let e = -excess / square;
        let s = e * (N::splat(0.5) - N::splat(0.125) * e);
        let change = change + (local + change) * s;
        let energy = local.dot(momentum);
        let gain = change.dot(momentum) * N::splat(2.0) + change.dot(self.inertia.apply(change));
        let is_kept = N::le(gain.max(-gain), N::splat(CONVERGED) * energy);
        select(is_kept, change, Vector::ZERO)
    }
}

#[inline(always)]
fn select<N: Lane>(mask: N::Mask, a: Vector<N>, b: Vector<N>) -> Vector<N> {
    Vector { x: N::select(mask, a.x, b.x), y: N::select(mask, a.y, b.y), z: N::select(mask, a.z, b.z) }
}

/// The componentwise product.
pub(super) fn scale_angular(w: Angular, factors: Angular) -> Angular {
    w.scale(factors)
}

/// Transforms an angular velocity into the frame of a body with this rotation.
#[inline(always)]
pub(super) fn to_body<N: Lane>(rotation: Rot<N>, w: Angular<N>) -> Angular<N> {
    rotation.inverse_rotate(w)
}

/// Transforms an angular velocity from the frame of a body with this rotation into world axes.
#[inline(always)]
pub(super) fn to_world<N: Lane>(rotation: Rot<N>, w: Angular<N>) -> Angular<N> {
    rotation.rotate(w)
}

/// The current rotation of a body, normalized: a length error that persists over the steps would change the
/// spin.
#[inline(always)]
pub(super) fn world_rotation<N: Lane>(delta: Rot<N>, start: Rot<N>) -> Rot<N> {
    delta.mul(start).renormalized()
}

/// The smallest rotation that takes the unit vector `axis` to its direction after `turn`. Returns `turn`
/// itself if `axis` is reversed.
pub(super) fn swing_of(axis: Angular, turn: Rot) -> Rot {
    let end = turn.rotate(axis);
    let (cross, w) = (axis.cross(end), 1.0 + axis.dot(end));
    if w < MIN_SWING { turn } else { Rot { x: cross.x, y: cross.y, z: cross.z, w }.normalized() }
}

/// A rotation vector about z by an angle in radians.
#[cfg(test)]
pub(super) fn spin(angle: f32) -> Angular {
    Vector::Z * angle
}

/// An isotropic inverse inertia.
#[cfg(test)]
pub(super) fn round(inverse: f32) -> InvInertia {
    InvInertia::from_diagonal(Vector::ONE * inverse)
}
