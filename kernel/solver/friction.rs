//! The friction of a contact row: central friction with its limit, torsional friction, and rolling
//! resistance.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::pair::{Pair, lanes_of_body};
use super::row::ContactRow;
use super::{BodyRow, GainRow, InvMass, RowView, SubstepParams, about, resist_rolling};
use crate::math::{DIM, Lane, TangentFrame, Vector, max};
use crate::tuning::solver::ROLL_FRICTION;

impl<N: Lane, M: InvMass<N>, const P: usize> ContactRow<N, M, P> {
    /// The velocity of B's surface over A's that a rotating platform has added since the start of the step.
    ///
    /// Arms are constant over the step. A body on a turntable would move along the tangent at the start of
    /// the step, and outward from step to step. The velocity of a body that contacts do not move is
    /// therefore taken at the position that the other body has in the middle of the substep. This adds ω ×
    /// Δ, where Δ is their relative displacement since the start of the step. ω is the rotation about the
    /// normal; rotation about other axes changes the normal, which also stays as at the start of the step.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the row.
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

    /// Central and torsional friction, together limited by μ times the normal impulse `load`. `carried` is
    /// the result of [`carried`](Self::carried).
    ///
    /// The impulses of the solve pass differ from the final impulses of the substep: a spring impulse is
    /// too large while it lifts a body, and a stopped body gets most of its impulse in the relax pass,
    /// after friction. The difference is owed: it is added to the limit of the next substep. The limits of
    /// all substeps thus add up to μ times the sum of their normal impulses.
    #[inline(always)]
    pub(super) fn solve_friction(&mut self, pair: &mut Pair<N>, carried: Vector<N>, load: N) {
        let n = self.normal;
        let frame = TangentFrame::new(n);
        let mut impulses = [N::ZERO; P];
        for i in 0..P {
            impulses[i] = self.points[i].impulse;
        }
        let [ra, rb] = self.surface_arms();
        let slip = self.slip(pair, &frame) - frame.project(carried);
        let stick = self.tangent_impulse - self.tangent_mass.apply(slip);
        let [slide, spin] =
            self.twist.limits(n, self.friction * load, impulses, (self.tangent_mass, stick), &pair.w);
        let new = self.tangent_mass.solve_coulomb(self.tangent_impulse, slip, slide);
        let impulse = frame.expand(new - self.tangent_impulse);
        self.tangent_impulse = new;
        self.push(pair, impulse, [ra.cross(impulse), rb.cross(impulse)]);
        self.twist.solve(n, spin, self.inv_inertia, &mut pair.w);
    }

    /// The rolling resistance of round shapes that roll slowly. It is not accumulated, so
    /// `gains` leave it out.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the gains of the row's dynamic bodies.
    #[inline(always)]
    pub(super) unsafe fn resist_rolling(
        &self,
        pair: &mut Pair<N>,
        gains: &RowView<GainRow>,
        load: N,
        params: &SubstepParams,
    ) {
        // Contacts with more points lie on a face, which does not roll.
        if P < DIM && params.roll_speed > 0.0 {
            let scale = self.rolling_arm() * N::splat(1.0 / max(params.roll_speed, 1.0e-9));
            let limit = self.friction.min(N::splat(ROLL_FRICTION)) * load * self.roll_lever;
            let before = pair.w;
            resist_rolling(self.normal, scale, limit, self.inv_inertia, &mut pair.w);
            for side in 0..2 {
                let change = pair.w[side] - before[side];
                if N::any(N::ZERO.lt(change.length_squared())) {
                    let share = if N::SHARES { N::ONE / lanes_of_body(&self.ids, side) } else { N::ONE };
                    // SAFETY: by the contract.
                    unsafe { GainRow::add_angular::<N>(gains, &self.ids[side], change * share) };
                }
            }
        }
    }
}
