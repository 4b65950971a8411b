//! Where the bodies of a joint are in a pass.

use super::super::pair::Pair;
use super::super::{BodyRow, InvMass, RowView};
use super::dim::{ANGLES, TURNS, angles, turn_axes};
use crate::math::{Angular, DIM, InvInertia, Lane, Rot, Vector};

/// The direction in which a coordinate grows: as a change of the bodies' velocities.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gradient<N> {
    /// The change along which B moves, and against which A moves.
    pub(super) normal: Vector<N>,
    /// The moments of A and of B.
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

    /// Writes those of a side where a mask is set.
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

    /// The changes of velocity by a unit impulse along a gradient.
    #[inline(always)]
    pub(super) fn response(&self, gradient: &Gradient<N>) -> Response<N> {
        let Gradient { normal, moments: [ma, mb] } = *gradient;
        Response {
            v: [self.linear[0].apply(normal), self.linear[1].apply(normal)],
            w: [self.angular[0].apply(ma), self.angular[1].apply(mb)],
        }
    }
}

/// The changes of velocity by a unit impulse. Those of A are against it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response<N> {
    pub(super) v: [Vector<N>; 2],
    pub(super) w: [Angular<N>; 2],
}

impl<N: Lane> Response<N> {
    pub(super) const NONE: Self = Self { v: [Vector::ZERO; 2], w: [Angular::ZERO; 2] };

    /// How fast another coordinate grows by it.
    #[inline(always)]
    pub(super) fn along(&self, g: &Gradient<N>) -> N {
        (self.v[0] + self.v[1]).dot(g.normal) + self.w[0].dot(g.moments[0]) + self.w[1].dot(g.moments[1])
    }

    /// Adds the response to another impulse.
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

/// Where two frames are at the start of the step.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Start<N> {
    /// From the centres of mass to the anchors.
    pub(super) arms: [Vector<N>; 2],
    /// From A's centre of mass to B's.
    pub(super) offset: Vector<N>,
    /// From the frames to the world.
    pub(super) bases: [Rot<N>; 2],
}

impl<N: Lane> Start<N> {
    pub(super) const NONE: Self =
        Self { arms: [Vector::ZERO; 2], offset: Vector::ZERO, bases: [Rot::IDENTITY; 2] };

    /// The place now.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies.
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

/// By how much the velocity of an arm's end changes its place in a substep beyond h ω × r, over h; see [`Place::drift`].
#[inline(always)]
fn bent<N: Lane>(w: Angular<N>, arm: Vector<N>, h: f32) -> Vector<N> {
    let (inward, turn) = (w.cross(w.cross(arm)), w.dot(w) * N::splat(h * h));
    let weight = (N::ONE - turn * turn).max(N::ZERO);
    (inward * N::splat(0.5 * h) + w.cross(inward) * N::splat(h * h / 6.0)) * weight
}

/// Where two frames are now.
#[derive(Clone, Copy)]
pub(super) struct Place<N> {
    /// From A's anchor to B's.
    pub(super) between: Vector<N>,
    /// From the centres of mass to B's anchor.
    arms: [Vector<N>; 2],
    /// From the frames to the world.
    pub(super) bases: [Rot<N>; 2],
}

impl<N: Lane> Place<N> {
    /// From B's centre of mass to its anchor.
    #[inline(always)]
    pub(super) fn arm(&self) -> Vector<N> {
        self.arms[1]
    }

    /// How fast the anchors part in a substep because bodies turn, beyond their velocities:
    /// h/2 ω × (ω × r) + h²/6 ω × (ω × (ω × r)), up to the third order. It fades towards a radian in a substep, beyond which
    /// it would drive what it follows.
    #[inline(always)]
    pub(super) fn drift(&self, pair: &Pair<N>, h: f32) -> Vector<N> {
        bent(pair.w[1], self.arms[1], h) - bent(pair.w[0], self.arms[0] - self.between, h)
    }

    /// The gradient of a shift along a direction, and of a turn.
    #[inline(always)]
    pub(super) fn gradient(&self, normal: Vector<N>, turn: Angular<N>) -> Gradient<N> {
        Gradient { normal, moments: [self.arms[0].cross(normal) + turn, self.arms[1].cross(normal) + turn] }
    }

    /// A's axes, or those of the world where the mask is set.
    #[inline(always)]
    pub(super) fn axes(&self, of_world: N::Mask) -> [Vector<N>; DIM] {
        let mut axes = [Vector::ZERO; DIM];
        for k in 0..DIM {
            let axis = Vector::splat(Vector::AXES[k]);
            axes[k] = Vector::select(of_world, axis, self.bases[0].rotate(axis));
        }
        axes
    }

    /// The axes of A about which bodies turn.
    #[inline(always)]
    pub(super) fn turn_axes(&self) -> [Angular<N>; TURNS] {
        turn_axes(self.bases[0])
    }

    /// The distance of the anchors, and the direction from A's to B's.
    #[inline(always)]
    pub(super) fn apart(&self) -> (N, Vector<N>) {
        let distance = self.between.length();
        let is_apart = N::ZERO.lt(distance);
        let scaled = self.between * (N::ONE / N::select(is_apart, distance, N::ONE));
        (distance, Vector::select(is_apart, scaled, Vector::splat(Vector::X)))
    }

    /// In place of the angles, where no coordinate is one.
    pub(super) const NO_ANGLES: [(N, Angular<N>); ANGLES] = [(N::ZERO, Angular::ZERO); ANGLES];

    /// The angles, and the axes about which they grow.
    #[inline(always)]
    pub(super) fn angles(&self) -> [(N, Angular<N>); ANGLES] {
        angles(self.bases)
    }
}
