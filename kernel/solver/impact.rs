//! Restitution: impacts within a substep, and rebounds after the last one.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::pair::Pair;
use super::{BodyRow, ContactRow, InvMass, RestitutionRow, RowView, SubstepParams};
use crate::math::{Angular, Lane, Tangent, TangentFrame};

impl<N: Lane, M: InvMass<N>, const P: usize> ContactRow<N, M, P> {
    /// The impact pass: points that close within this substep, and faster than the threshold, rebound before any other
    /// pass sees them, as if they had touched at the right time within the substep. Their impulses are added to `sum`. Returns
    /// whether any rebounded.
    ///
    /// # Safety
    /// Until it returns, no other thread reads or writes those bodies of the row that may be written, or writes the others.
    #[inline(always)]
    pub(super) unsafe fn impact(
        &mut self,
        rows: &RowView<BodyRow>,
        bounce: &mut RestitutionRow<N, P>,
        sum: Option<&mut [N; P]>,
        params: &SubstepParams,
    ) -> bool {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.ids) };
        debug_assert!(!N::SHARES, "rows that share bodies have no restitution");
        let n = self.normal;
        let threshold = N::splat(-params.restitution_threshold);
        let mut moments = [[Angular::ZERO; 2]; P];
        let mut speeds = [N::ZERO; P];
        let mut fastest = N::ZERO;
        for i in 0..P {
            let anchor = self.points[i].anchor;
            moments[i] = [anchor.cross(n), (anchor - self.offset).cross(n)];
            speeds[i] = pair.along(n, moments[i]);
            fastest = fastest.min(speeds[i] + bounce.gained);
        }
        let fast = N::and(fastest.lt(threshold), N::ZERO.lt(bounce.restitution));
        if !N::any(fast) {
            return false;
        }
        // SAFETY: by the contract.
        let [(mut pa, qa), (mut pb, qb)] = unsafe {
            [BodyRow::gather_delta::<N>(rows, &self.ids[0]), BodyRow::gather_delta::<N>(rows, &self.ids[1])]
        };
        let shift = (pb - pa).dot(n);
        let mut targets = [N::ZERO; P];
        let mut early = N::splat(f32::MAX);
        for i in 0..P {
            let (ra, rb) = (self.points[i].anchor, self.points[i].anchor - self.offset);
            let [ma, mb] = moments[i];
            let moved = shift + qb.shift_along(rb, mb, n) - qa.shift_along(ra, ma, n);
            let s = self.points[i].separation + moved;
            let approach = speeds[i] + bounce.gained;
            let soon = (s + speeds[i] * N::splat(params.h)).lt(N::ZERO);
            let closing = N::and(approach.lt(threshold), speeds[i].lt(N::ZERO));
            let hit = N::and(N::and(fast, closing), soon);
            let hit = N::and(hit, N::ZERO.lt(self.points[i].mass));
            let (speed, ahead) =
                bounce.rebound(s.max(N::ZERO), -approach, -speeds[i], N::splat(params.inv_h));
            targets[i] = N::select(hit, speed, N::ZERO);
            early = N::select(hit, early.min(ahead), early);
            bounce.approach[i] = N::select(hit, N::ZERO, bounce.approach[i]);
        }
        let mut any = N::ZERO;
        for target in targets {
            any = any.max(target);
        }
        let hit = N::ZERO.lt(any);
        let before = pair;
        let impulses = self.collide(&mut pair, bounce, &targets, &moments);
        for (sum, impulse) in sum.into_iter().flatten().zip(impulses) {
            *sum += impulse;
        }
        // SAFETY: by the contract.
        unsafe { pair.or_where_not(hit, before).store(rows, &self.ids) };

        let [ma, mb] = [self.inv_mass[0].apply(n), self.inv_mass[1].apply(n)];
        let k = (ma + mb).dot(n);
        let lag = N::select(N::and(hit, N::ZERO.lt(k)), early / k, N::ZERO);
        pa += ma * lag;
        pb -= mb * lag;
        // SAFETY: by the contract.
        unsafe {
            BodyRow::scatter_delta::<N>(rows, &self.ids[0], pa, qa);
            BodyRow::scatter_delta::<N>(rows, &self.ids[1], pb, qb);
        }
        N::any(hit)
    }

    /// Applies one impulse, shared equally by the points that have a target, that gives them their targets on average.
    /// Returns the impulses.
    ///
    /// A body that lands flat then has them already. Sweeps alone leave 0.3 % of the impact, which is much of a weak
    /// rebound: at e = 0.1 a cube lost 3.5 % of its height.
    #[inline(always)]
    fn share_impact(&self, pair: &mut Pair<N>, targets: &[N; P], moments: &[[Angular<N>; 2]; P]) -> [N; P] {
        let mut impulses = [N::ZERO; P];
        if P == 1 {
            return impulses;
        }
        let n = self.normal;
        let (mut count, mut missing) = (N::ZERO, N::ZERO);
        let mut arms = [Angular::ZERO; 2];
        for i in 0..P {
            let hit = N::select(N::ZERO.lt(targets[i]), N::ONE, N::ZERO);
            count += hit;
            missing += (targets[i] - pair.along(n, moments[i])) * hit;
            arms[0] += moments[i][0] * hit;
            arms[1] += moments[i][1] * hit;
        }
        let share = N::ONE / count.max(N::ONE);
        arms = arms.map(|arm| arm * share);
        let k = n.dot(self.inv_mass[0].apply(n) + self.inv_mass[1].apply(n))
            + arms[0].dot(self.inv_inertia[0].apply(arms[0]))
            + arms[1].dot(self.inv_inertia[1].apply(arms[1]));
        let total = N::select(N::ZERO.lt(k), missing * share / k, N::ZERO).max(N::ZERO);
        for i in 0..P {
            impulses[i] = N::select(N::ZERO.lt(targets[i]), total * share, N::ZERO);
        }
        self.push(pair, n * total, [arms[0] * total, arms[1] * total]);
        impulses
    }

    /// Scales the impulses of an impact so that points reach their targets on average, weighted by impulse.
    ///
    /// The sweeps end before points have their targets. Impulses λ change the energy by ½ Σ λᵢ (vᵢ + vᵢ') if they change the normal
    /// velocities from v to v'. With Σ λᵢ vᵢ' = Σ λᵢ wᵢ this is what it would be if all had their targets w: for w = −e v never
    /// a gain. As v' = v + s K λ, the scale is s = Σ λᵢ (wᵢ − vᵢ) / λᵀ K λ.
    #[inline(always)]
    fn scale_impact(
        &self,
        pair: &mut Pair<N>,
        before: &Pair<N>,
        impulses: &mut [N; P],
        targets: &[N; P],
        moments: &[[Angular<N>; 2]; P],
    ) {
        if P == 1 {
            return;
        }
        let n = self.normal;
        let (mut wanted, mut got, mut total) = (N::ZERO, N::ZERO, N::ZERO);
        let mut arms = [Angular::ZERO; 2];
        for i in 0..P {
            let old = before.along(n, moments[i]);
            wanted += impulses[i] * (targets[i] - old);
            got += impulses[i] * (pair.along(n, moments[i]) - old);
            total += impulses[i];
            arms[0] += moments[i][0] * impulses[i];
            arms[1] += moments[i][1] * impulses[i];
        }
        let scale = N::select(N::ZERO.lt(got), wanted / got, N::ONE);
        let more = scale - N::ONE;
        for impulse in impulses {
            *impulse = *impulse * scale;
        }
        self.push(pair, n * (total * more), [arms[0] * more, arms[1] * more]);
    }

    /// Gives each point its target normal velocity, where that is not 0, by an impulse that only pushes, and then
    /// friction. Returns the normal impulses.
    #[inline(always)]
    fn collide(
        &mut self,
        pair: &mut Pair<N>,
        bounce: &mut RestitutionRow<N, P>,
        targets: &[N; P],
        moments: &[[Angular<N>; 2]; P],
    ) -> [N; P] {
        let n = self.normal;
        let before = *pair;
        let mut impulses = self.share_impact(pair, targets, moments);
        // A few sweeps in alternating order: points of one manifold share the impact, and none comes first.
        for sweep in 0..if P == 1 { 1 } else { 4 } {
            for k in 0..P {
                let i = if sweep % 2 == 0 { k } else { P - 1 - k };
                let change = self.points[i].mass * (pair.along(n, moments[i]) - targets[i]);
                let new = N::select(N::ZERO.lt(targets[i]), (impulses[i] - change).max(N::ZERO), N::ZERO);
                let delta = new - impulses[i];
                impulses[i] = new;
                self.push(pair, n * delta, [moments[i][0] * delta, moments[i][1] * delta]);
            }
        }
        self.scale_impact(pair, &before, &mut impulses, targets, moments);
        let mut sum = N::ZERO;
        for i in 0..P {
            bounce.max_impulse[i] = bounce.max_impulse[i].max(impulses[i]);
            sum += impulses[i];
        }
        let frame = TangentFrame::new(n);
        let wanted = Tangent::ZERO - self.tangent_mass.apply(self.slip(pair, &frame));
        let rubbed = frame.expand(wanted.clamp_length(self.friction * sum));
        let [ra, rb] = self.surface_arms();
        self.push(pair, rubbed, [ra.cross(rubbed), rb.cross(rubbed)]);
        impulses
    }

    /// The restitution pass: points that approached faster than the threshold and had an impulse leave with e times the
    /// approach speed. Points that the impact pass has handled are skipped. Impulses are added to `sum`.
    ///
    /// Other impacts may have slowed a point down before it touched, so its approach speed alone would add energy. Impulses λ that
    /// stop points absorb ½ λᵀ K λ, and what the rebound returns is at most e² of that.
    ///
    /// # Safety
    /// Until it returns, no other thread reads or writes those bodies of the row that may be written, or writes the others.
    #[inline(always)]
    pub(super) unsafe fn restitute(
        &mut self,
        rows: &RowView<BodyRow>,
        bounce: &mut RestitutionRow<N, P>,
        mut sum: Option<&mut [N; P]>,
        params: &SubstepParams,
    ) {
        let threshold = N::splat(-params.restitution_threshold);
        let (mut hit, mut any) = ([N::ZERO; P], N::ZERO);
        for i in 0..P {
            let fast = N::and(bounce.approach[i].lt(threshold), N::ZERO.lt(bounce.max_impulse[i]));
            hit[i] = N::select(N::and(fast, N::ZERO.lt(bounce.restitution)), N::ONE, N::ZERO);
            any = any.max(hit[i]);
        }
        if !N::any(N::ZERO.lt(any)) {
            return;
        }
        // SAFETY: by the contract.
        let before = unsafe { Pair::load(rows, &self.ids) };
        let n = self.normal;
        let (mut pair, mut stop) = (before, Pair::REST);
        let mut moments = [[Angular::ZERO; 2]; P];
        let mut deltas = [N::ZERO; P];
        for i in 0..P {
            let point = self.points[i];
            let (ma, mb) = (point.anchor.cross(n), (point.anchor - self.offset).cross(n));
            moments[i] = [ma, mb];
            let missing = pair.along(n, moments[i]) + bounce.restitution * bounce.approach[i];
            let new = (point.impulse - point.mass * missing).max(N::ZERO);
            let delta = (new - point.impulse) * hit[i];
            deltas[i] = delta;
            self.push(&mut pair, n * delta, [ma * delta, mb * delta]);
            let stopping = bounce.max_impulse[i] * hit[i];
            self.push(&mut stop, n * stopping, [ma * stopping, mb * stopping]);
        }
        // Impulses scaled by s change the energy by a s + ½ b s².
        let (mut a, mut b, mut absorbed) = (N::ZERO, N::ZERO, N::ZERO);
        for i in 0..P {
            let old = before.along(n, moments[i]);
            a += deltas[i] * old;
            b += deltas[i] * (pair.along(n, moments[i]) - old);
            absorbed += bounce.max_impulse[i] * hit[i] * stop.along(n, moments[i]);
        }
        let returned = bounce.restitution * bounce.restitution * absorbed;
        let root = (a * a + b * returned).max(N::ZERO).sqrt();
        let scale = N::select(N::ZERO.lt(b), ((root - a) / b).min(N::ONE), N::ONE);
        pair = before;
        for i in 0..P {
            let delta = deltas[i] * scale;
            self.points[i].impulse += delta;
            bounce.max_impulse[i] = bounce.max_impulse[i].max(self.points[i].impulse);
            if let Some(sum) = &mut sum {
                sum[i] += delta;
            }
            self.push(&mut pair, n * delta, moments[i].map(|moment| moment * delta));
        }
        // SAFETY: by the contract.
        unsafe { pair.or_where_not(N::ZERO.lt(any), before).store(rows, &self.ids) };
    }
}

impl<N: Lane, const P: usize> RestitutionRow<N, P> {
    /// The rebound of a point that touches within a substep: the speed at which it leaves, and its displacement at the
    /// end of the substep that this speed does not account for, because the point touches only after `gap` / `speed`.
    /// `approach` is the speed before the substep's accelerations, `speed` the one after.
    ///
    /// Symplectic Euler conserves E = ½ v² + g y − ½ g h v of a free fall exactly (v upward). The speed w makes E after
    /// the substep, at y = w (h − t), e² times the E before. The rebound height is e² of the fall height at any step
    /// length, and no energy is gained.
    #[inline(always)]
    fn rebound(&self, gap: N, approach: N, speed: N, inv_h: N) -> (N, N) {
        let half = N::splat(0.5);
        let time = gap / speed;
        // g h and g t, with t = gap / speed.
        let (gh, gt) = (self.gained, self.gained * inv_h * time);
        let kept = half * approach * approach + speed * gt + half * gh * approach;
        let b = half * gh - gt;
        let e2 = self.restitution * self.restitution;
        let parting = (b * b + (e2 + e2) * kept.max(N::ZERO)).sqrt() - b;
        (parting, gap + parting * time)
    }
}
