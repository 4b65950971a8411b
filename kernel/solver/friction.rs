//! The friction of a contact row: central friction with its limit, and rolling resistance.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::pair::Pair;
use super::resistance::ROLL_FRICTION;
use super::row::ContactRow;
use super::{BodyRow, InvMass, RowView, SubstepParams, about, resist_rolling};
use crate::math::{DIM, Lane, TangentFrame, Vector, max};

/// Normal impulses before and after the solve pass are alike if they differ by less than this share. The soft constraint
/// changes those of a body at rest by up to 3 %. More makes the limit lag after a blow.
const ALIKE: f32 = 0.1;

impl<N: Lane, M: InvMass<N>, const P: usize> ContactRow<N, M, P> {
    /// What the velocity of B's surface over A's gains by the turn of a platform since the start of the step.
    ///
    /// Arms are those of the start of the step. A body that rides a turntable would move along a tangent of that time, and
    /// outward from step to step. So the velocity of a body that contacts do not move is taken at the place where the other
    /// body is in the middle of the substep: ω × Δ, where Δ is how far they moved against each other since. ω is the turn about
    /// the normal; other turns change the normal, which is also that of the start of the step.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the row.
    #[inline(always)]
    pub(super) unsafe fn carried(
        &self,
        rows: &RowView<BodyRow>,
        pair: &Pair<N>,
        params: &SubstepParams,
    ) -> Vector<N> {
        let held = |side: usize| N::select(self.inv_mass[side].is_zero(), N::ONE, N::ZERO);
        let turn = about(self.normal, pair.w[0] * held(0) + pair.w[1] * held(1));
        if !N::any(N::ZERO.lt(turn.length_squared())) {
            return Vector::ZERO;
        }
        // SAFETY: by the contract.
        let [(pa, _), (pb, _)] = unsafe {
            [BodyRow::gather_delta::<N>(rows, &self.ids[0]), BodyRow::gather_delta::<N>(rows, &self.ids[1])]
        };
        turn.cross(pb - pa - (pair.v[1] - pair.v[0]) * N::splat(0.5 * params.h))
    }

    /// Central friction, limited by μ times the sum of normal impulses, torsional friction, and the rolling resistance of
    /// round cores that move slowly. `carried` is as in [`carried`](Self::carried).
    ///
    /// The impulses of the solve pass are those of a spring: too large while it lifts a body, too small while a body sinks to
    /// rest, as it does after every change of points. The substep began with those of the last relax pass, which sum up to
    /// the weight. They are the limit where both differ little; a blow has only those of the solve pass.
    #[inline(always)]
    pub(super) fn solve_friction(&mut self, pair: &mut Pair<N>, carried: Vector<N>, params: &SubstepParams) {
        let n = self.normal;
        let frame = TangentFrame::new(n);
        let mut impulses = [N::ZERO; P];
        for i in 0..P {
            impulses[i] = self.points[i].impulse;
        }
        self.twist.solve(n, self.friction, impulses, self.inv_inertia, &mut pair.w);

        let pressure = self.pressure();
        let is_alike = N::and(
            (pressure * N::splat(1.0 - ALIKE)).le(self.load),
            self.load.le(pressure * N::splat(1.0 + ALIKE)),
        );
        let sum = N::select(is_alike, self.load, pressure);
        let [ra, rb] = self.surface_arms();
        let slip = self.slip(pair, &frame) - frame.project(carried);
        let new = self.tangent_mass.rub(self.tangent_impulse, slip, self.friction * sum);
        let impulse = frame.expand(new - self.tangent_impulse);
        self.tangent_impulse = new;
        self.push(pair, impulse, [ra.cross(impulse), rb.cross(impulse)]);
        // Contacts with more points bear on a face, which does not roll.
        if P < DIM && params.roll_speed > 0.0 {
            let reach = self.rolling_arm();
            let scale = reach * N::splat(1.0 / max(params.roll_speed, 1.0e-9));
            let friction = self.friction.min(N::splat(ROLL_FRICTION));
            resist_rolling(n, scale, friction * sum * self.roll_lever, self.inv_inertia, &mut pair.w);
        }
    }
}
