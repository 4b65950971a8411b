//! Positions, gradients and responses of a joint's bodies in a pass.

use super::super::pair::Pair;
use super::super::{BodyRow, InvMass, RowView};
use super::dim::{ANGLES, TURNS, angles, turn_axes};
use crate::math::{Angular, DIM, InvInertia, Lane, Rot, Vector};

/// The gradient of a coordinate with respect to the motion of the bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gradient<N> {
    /// The direction in which B moves as the coordinate grows; A moves against it.
    pub(super) normal: Vector<N>,
    /// The moments of the normal about A and B.
    pub(super) moments: [Angular<N>; 2],
}

impl<N: Lane> Gradient<N> {
    pub(super) const NONE: Self = Self { normal: Vector::ZERO, moments: [Angular::ZERO; 2] };

    /// The rate of the coordinate.
    #[inline(always)]
    pub(super) fn rate(&self, pair: &Pair<N>) -> N {
        pair.along(self.normal, self.moments)
    }
}

/// Inverse masses of a joint's bodies.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Masses<N> {
    /// Inverse mass along each world axis, 1/kg. 0 along locked axes.
    pub(super) linear: [Vector<N>; 2],
    pub(super) angular: [InvInertia<N>; 2],
}

impl<N: Lane> Masses<N> {
    pub(super) const NONE: Self = Self { linear: [Vector::ZERO; 2], angular: [InvInertia::ZERO; 2] };

    /// Sets the masses of one side in the lanes of a mask.
    #[inline(always)]
    pub(super) fn set_where(
        &mut self,
        mask: N::Mask,
        side: usize,
        linear: Vector<N>,
        angular: InvInertia<N>,
    ) {
        self.linear[side] = Vector::select(mask, linear, self.linear[side]);
        self.angular[side] = InvInertia::select(mask, angular, self.angular[side]);
    }

    /// The velocity changes by a unit impulse along a gradient.
    #[inline(always)]
    pub(super) fn response(&self, gradient: &Gradient<N>) -> Response<N> {
        let Gradient { normal, moments: [ma, mb] } = *gradient;
        Response {
            v: [self.linear[0].apply(normal), self.linear[1].apply(normal)],
            w: [self.angular[0].apply(ma), self.angular[1].apply(mb)],
        }
    }
}

/// The velocity changes of both bodies by a unit impulse. The sign of A's changes is reversed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response<N> {
    pub(super) v: [Vector<N>; 2],
    pub(super) w: [Angular<N>; 2],
}

impl<N: Lane> Response<N> {
    pub(super) const NONE: Self = Self { v: [Vector::ZERO; 2], w: [Angular::ZERO; 2] };

    /// The rate of another coordinate due to the unit impulse.
    #[inline(always)]
    pub(super) fn along(&self, g: &Gradient<N>) -> N {
        (self.v[0] + self.v[1]).dot(g.normal) + self.w[0].dot(g.moments[0]) + self.w[1].dot(g.moments[1])
    }

    /// Adds `impulse` times another response.
    #[inline(always)]
    pub(super) fn add(&mut self, other: &Self, impulse: N) {
        for side in 0..2 {
            self.v[side] += other.v[side] * impulse;
            self.w[side] += other.w[side] * impulse;
        }
    }

    /// Applies an impulse.
    #[inline(always)]
    pub(super) fn push(&self, pair: &mut Pair<N>, impulse: N) {
        pair.v[0] -= self.v[0] * impulse;
        pair.w[0] -= self.w[0] * impulse;
        pair.v[1] += self.v[1] * impulse;
        pair.w[1] += self.w[1] * impulse;
    }
}

/// The positions of both frames at the start of the step.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Start<N> {
    /// Vectors from the centres of mass to the anchors.
    pub(super) arms: [Vector<N>; 2],
    /// Vector from A's centre of mass to B's.
    pub(super) offset: Vector<N>,
    /// Rotations from the frames to the world.
    pub(super) bases: [Rot<N>; 2],
}

impl<N: Lane> Start<N> {
    pub(super) const NONE: Self =
        Self { arms: [Vector::ZERO; 2], offset: Vector::ZERO, bases: [Rot::IDENTITY; 2] };

    /// The current positions of the frames.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies.
    #[expect(unsafe_code, reason = "rows of bodies are shared by threads")]
    #[inline(always)]
    pub(super) unsafe fn now(&self, bodies: &RowView<BodyRow>, ids: &[N::Ids; 2]) -> Place<N> {
        // SAFETY: by the contract.
        let [(pa, qa), (pb, qb)] = unsafe {
            [BodyRow::gather_delta::<N>(bodies, &ids[0]), BodyRow::gather_delta::<N>(bodies, &ids[1])]
        };
        let [ra, rb] = [qa.rotate(self.arms[0]), qb.rotate(self.arms[1])];
        let between = self.offset + pb - pa + rb - ra;
        Place { between, arms: [ra + between, rb], bases: [qa.mul(self.bases[0]), qb.mul(self.bases[1])] }
    }
}

/// The displacement of an arm's end in a substep beyond h ω × r, divided by h; see [`Place::drift`].
#[inline(always)]
fn bent<N: Lane>(w: Angular<N>, arm: Vector<N>, h: f32) -> Vector<N> {
    let (inward, turn) = (w.cross(w.cross(arm)), w.dot(w) * N::splat(h * h));
    let weight = (N::ONE - turn * turn).max(N::ZERO);
    (inward * N::splat(0.5 * h) + w.cross(inward) * N::splat(h * h / 6.0)) * weight
}

/// The current positions of both frames.
#[derive(Clone, Copy)]
pub(super) struct Place<N> {
    /// Vector from A's anchor to B's.
    pub(super) between: Vector<N>,
    /// Vectors from the centres of mass to B's anchor.
    arms: [Vector<N>; 2],
    /// Rotations from the frames to the world.
    pub(super) bases: [Rot<N>; 2],
}

impl<N: Lane> Place<N> {
    /// Vector from B's centre of mass to its anchor.
    #[inline(always)]
    pub(super) fn arm(&self) -> Vector<N> {
        self.arms[1]
    }

    /// The velocity at which rotation separates the anchors in a substep, beyond their linear velocities:
    /// h/2 ω × (ω × r) + h²/6 ω × (ω × (ω × r)), up to third order. It fades towards one radian per
    /// substep; beyond that, it would drive the rotation that it follows.
    #[inline(always)]
    pub(super) fn drift(&self, pair: &Pair<N>, h: f32) -> Vector<N> {
        bent(pair.w[1], self.arms[1], h) - bent(pair.w[0], self.arms[0] - self.between, h)
    }

    /// The gradient of a shift along a direction plus a turn about an axis.
    #[inline(always)]
    pub(super) fn gradient(&self, normal: Vector<N>, turn: Angular<N>) -> Gradient<N> {
        Gradient { normal, moments: [self.arms[0].cross(normal) + turn, self.arms[1].cross(normal) + turn] }
    }

    /// A's axes, or the world axes in the lanes of the mask.
    #[inline(always)]
    pub(super) fn axes(&self, of_world: N::Mask) -> [Vector<N>; DIM] {
        let mut axes = [Vector::ZERO; DIM];
        for k in 0..DIM {
            let axis = Vector::splat(Vector::AXES[k]);
            axes[k] = Vector::select(of_world, axis, self.bases[0].rotate(axis));
        }
        axes
    }

    /// The axes of A about which bodies rotate.
    #[inline(always)]
    pub(super) fn turn_axes(&self) -> [Angular<N>; TURNS] {
        turn_axes(self.bases[0])
    }

    /// The distance between the anchors, and the direction from A's to B's.
    #[inline(always)]
    pub(super) fn apart(&self) -> (N, Vector<N>) {
        let distance = self.between.length();
        let is_apart = N::ZERO.lt(distance);
        let scaled = self.between * (N::ONE / N::select(is_apart, distance, N::ONE));
        (distance, Vector::select(is_apart, scaled, Vector::splat(Vector::X)))
    }

    /// Stands in for the angles if no coordinate is an angle.
    pub(super) const NO_ANGLES: [(N, Angular<N>); ANGLES] = [(N::ZERO, Angular::ZERO); ANGLES];

    /// The angles, and the axis about which each angle grows.
    #[inline(always)]
    pub(super) fn angles(&self) -> [(N, Angular<N>); ANGLES] {
        angles(self.bases)
    }
}
