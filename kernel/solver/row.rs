//! One contact manifold as solver rows, written once for 2D and 3D, one lane or many.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::pair::{Pair, SoftLanes};
use super::{BodyRow, InvMass, RowView, SubstepParams, Twist};
use crate::math::{Angular, Ids, InvInertia, Lane, Tangent, TangentFrame, TangentMass, Vector};

/// One point of a manifold.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct PointRow<N> {
    /// From body A's centre of mass to A's core (see [`Shape::radius`](crate::shape::Shape::radius)) when
    /// the step begins; from body B's to B's core it is this less the row's offset.
    pub anchor: Vector<N>,
    /// The separation when the step begins, in metres.
    pub separation: N,
    /// The effective mass along the normal, kg.
    pub mass: N,
    /// The accumulated normal impulse, N·s, ≥ 0.
    pub impulse: N,
}

/// The manifolds of `N::WIDTH` contacts with at most `P` points each.
///
/// Anchors and normals are fixed over the step; separations follow the bodies' exact motion. Points that
/// a lane does not have carry zero mass.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct ContactRow<N: Lane, M, const P: usize> {
    /// Body rows A and B.
    pub ids: [N::Ids; 2],
    /// 1/kg: one number, or one for each axis where a body is held along some.
    pub inv_mass: [M; 2],
    /// In world axes.
    pub inv_inertia: [InvInertia<N>; 2],
    /// From A to B.
    pub normal: Vector<N>,
    /// Takes a point's anchor from A's centre of mass to one from B's.
    pub offset: Vector<N>,
    /// How far A's surface is from A's core, plus B's from B's, in metres.
    pub rounding: N,
    /// The mixed friction coefficient.
    pub friction: N,
    /// The fastest that overlap is pushed out, m/s.
    pub push_speed: N,
    /// The velocity that friction drives B's surface to, relative to A's, in the tangent space.
    pub surface_velocity: Tangent<N>,
    /// The friction row's anchor from A.
    pub center: Vector<N>,
    /// The friction row's effective mass.
    pub tangent_mass: TangentMass<N>,
    /// The accumulated friction impulse, N·s.
    pub tangent_impulse: Tangent<N>,
    /// Friction against turning about the normal.
    pub twist: Twist<N, P>,
    /// The points.
    pub points: [PointRow<N>; P],
}

/// What only bouncing needs, apart from the rows that every pass sweeps.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct RestitutionRow<N: Lane, const P: usize> {
    /// The mixed coefficient of restitution.
    pub restitution: N,
    /// The approach speed that accelerations add in a substep, m/s.
    pub gained: N,
    /// The normal velocity of each point when the step began, m/s; 0 once it has bounced.
    pub approach: [N; P],
    /// The largest impulse of each point so far in the step, N·s.
    pub max_impulse: [N; P],
}

/// What only a step with deep overlap needs of a row.
///
/// Decision: the push that takes out deep overlap only moves the bodies; what it does to their velocities
/// is taken back before the relax pass, impulse by impulse, which conserves momentum. That pass alone would
/// not do so: it lowers an impulse only where bodies come apart, so that inside a crowd, where the pushes
/// from all sides balance, they add up over the substeps as in a compressed spring, and whatever is at the
/// edge is flung off. The pass without bias stops what approaches, as ever.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct SplitImpulseRow<N: Lane, const P: usize> {
    /// 1 where a body of the contact overlaps something deeply, else 0.
    pub deep: N,
    /// The share of the impulses that a substep starts from.
    pub warm: N,
    /// The impulse of each point before overlap is pushed out, N·s.
    pub before: [N; P],
}

const _: () = {
    use crate::math::{DIM, F32x4};
    let two = size_of::<ContactRow<F32x4, F32x4, 2>>() / 4;
    let four = size_of::<ContactRow<F32x4, F32x4, 4>>() / 4;
    assert!(if DIM == 2 { two <= 156 } else { four <= 400 }, "a contact row outgrew its budget");
};

impl<N: Lane, M: InvMass<N>, const P: usize> Default for ContactRow<N, M, P> {
    fn default() -> Self {
        Self {
            ids: [N::Ids::splat(0); 2],
            inv_mass: [M::ZERO; 2],
            inv_inertia: [InvInertia::ZERO; 2],
            normal: Vector::ZERO,
            offset: Vector::ZERO,
            rounding: N::ZERO,
            friction: N::ZERO,
            push_speed: N::ZERO,
            surface_velocity: Tangent::ZERO,
            center: Vector::ZERO,
            tangent_mass: TangentMass::default(),
            tangent_impulse: Tangent::ZERO,
            twist: Twist::default(),
            points: [PointRow::default(); P],
        }
    }
}

impl<N: Lane, const P: usize> Default for RestitutionRow<N, P> {
    fn default() -> Self {
        Self { restitution: N::ZERO, gained: N::ZERO, approach: [N::ZERO; P], max_impulse: [N::ZERO; P] }
    }
}

impl<N: Lane, const P: usize> Default for SplitImpulseRow<N, P> {
    fn default() -> Self {
        Self { deep: N::ZERO, warm: N::ONE, before: [N::ZERO; P] }
    }
}

impl<N: Lane, M: InvMass<N>, const P: usize> ContactRow<N, M, P> {
    /// Applies `impulse` at the arms whose moments with it are `moments`.
    #[inline(always)]
    fn push(&self, pair: &mut Pair<N>, impulse: Vector<N>, moments: [Angular<N>; 2]) {
        pair.v[0] -= self.inv_mass[0].apply(impulse);
        pair.w[0] -= self.inv_inertia[0].apply(moments[0]);
        pair.v[1] += self.inv_mass[1].apply(impulse);
        pair.w[1] += self.inv_inertia[1].apply(moments[1]);
    }

    /// Applies the accumulated impulses.
    ///
    /// # Safety
    /// No other thread reads or writes the row's bodies that may be written, nor writes the others.
    #[inline(always)]
    pub(super) unsafe fn warm_start(&self, rows: &RowView<BodyRow>) {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.ids) };
        // All impulses of the manifold as one impulse and one moment for each body.
        let mut impulse = TangentFrame::new(self.normal).expand(self.tangent_impulse);
        let [ra, rb] = self.surface_arms();
        let mut moments = [ra.cross(impulse), rb.cross(impulse)];
        for point in &self.points {
            let p = self.normal * point.impulse;
            impulse += p;
            moments[0] += point.anchor.cross(p);
            moments[1] += (point.anchor - self.offset).cross(p);
        }
        self.push(&mut pair, impulse, moments);
        self.twist.warm_start(self.normal, self.inv_inertia, &mut pair.w);
        // SAFETY: by the contract.
        unsafe { pair.store(rows, &self.ids) };
    }

    /// The soft-bias pass: non-penetration with position error fed back.
    ///
    /// # Safety
    /// No other thread reads or writes the row's bodies that may be written, nor writes the others.
    #[inline(always)]
    pub(super) unsafe fn solve(&mut self, rows: &RowView<BodyRow>, params: &SubstepParams) {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.ids) };
        let immovable = N::or(self.inv_mass[0].is_zero(), self.inv_mass[1].is_zero());
        let soft = SoftLanes::select(immovable, &params.stiff, &params.soft);
        // SAFETY: by the contract.
        unsafe { self.solve_normals(rows, &mut pair, params, Some(soft), None) };
        // SAFETY: by the contract.
        unsafe { pair.store(rows, &self.ids) };
    }

    /// The relax pass: friction, then non-penetration without bias.
    ///
    /// Friction stands between two sweeps over the normal rows, that of the solve pass and this one. With
    /// friction last a wall of boxes shook itself ever faster, and crept by shaking: one sweep a substep, warm
    /// started, does not reach the solution but swings about it, and some orders feed the swing (measured: a
    /// pyramid of base 16 at rest reached 0.2 m/s in 50 s; now it comes to rest).
    ///
    /// Where `restitution` is given and not 0, what closes fast is not slowed down before it meets: the impact
    /// pass will see to it.
    ///
    /// # Safety
    /// No other thread reads or writes the row's bodies that may be written, nor writes the others.
    #[inline(always)]
    pub(super) unsafe fn relax(
        &mut self,
        rows: &RowView<BodyRow>,
        params: &SubstepParams,
        restitution: Option<N>,
    ) {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.ids) };
        self.solve_friction(&mut pair);
        // SAFETY: by the contract.
        unsafe { self.solve_normals(rows, &mut pair, params, None, restitution) };
        // SAFETY: by the contract.
        unsafe { pair.store(rows, &self.ids) };
    }

    /// Lets the substep start from the row's share of the impulses.
    #[inline(always)]
    pub(super) fn scale_impulses(&mut self, split: &SplitImpulseRow<N, P>) {
        for point in &mut self.points {
            point.impulse = point.impulse * split.warm;
        }
    }

    /// Notes the impulses that [`undo_split`](Self::undo_split) returns to.
    #[inline(always)]
    pub(super) fn save_impulses(&self, split: &mut SplitImpulseRow<N, P>) {
        for (before, point) in split.before.iter_mut().zip(&self.points) {
            *before = point.impulse;
        }
    }

    /// Takes back the impulses of the soft-bias pass where overlap is deep, once they have moved the bodies.
    ///
    /// # Safety
    /// No other thread reads or writes the row's bodies that may be written, nor writes the others.
    #[inline(always)]
    pub(super) unsafe fn undo_split(&mut self, rows: &RowView<BodyRow>, split: &SplitImpulseRow<N, P>) {
        // SAFETY: by the contract.
        let before = unsafe { Pair::load(rows, &self.ids) };
        let mut pair = before;
        let n = self.normal;
        for i in 0..P {
            let point = self.points[i];
            let delta = (split.before[i] - point.impulse) * split.deep;
            let (ma, mb) = (point.anchor.cross(n), (point.anchor - self.offset).cross(n));
            self.points[i].impulse = point.impulse + delta;
            self.push(&mut pair, n * delta, [ma * delta, mb * delta]);
        }
        // SAFETY: by the contract.
        unsafe { pair.or_where_not(N::ZERO.lt(split.deep), before).store(rows, &self.ids) };
    }

    /// Notes the impulses that the restitution pass looks back on.
    #[inline(always)]
    pub(super) fn note_largest_impulses(&self, bounce: &mut RestitutionRow<N, P>) {
        for (max, point) in bounce.max_impulse.iter_mut().zip(&self.points) {
            *max = max.max(point.impulse);
        }
    }

    /// One normal row a point: λ' = max(λ − m (k_m (v_n + b)) − k_i λ, 0), where b is s/h while the
    /// point is apart (it may close exactly that far), the soft bias where it overlaps and `soft` is
    /// given, else 0.
    ///
    /// # Safety
    /// No other thread reads or writes the row's bodies that may be written, nor writes the others.
    #[inline(always)]
    unsafe fn solve_normals(
        &mut self,
        rows: &RowView<BodyRow>,
        pair: &mut Pair<N>,
        params: &SubstepParams,
        soft: Option<SoftLanes<N>>,
        restitution: Option<N>,
    ) {
        // SAFETY: by the contract.
        let [(pa, qa), (pb, qb)] = unsafe {
            [BodyRow::gather_delta::<N>(rows, &self.ids[0]), BodyRow::gather_delta::<N>(rows, &self.ids[1])]
        };
        let n = self.normal;
        let (inv_h, slowest) = (N::splat(params.inv_h), -self.push_speed);
        let shift = (pb - pa).dot(n);
        for k in 0..P {
            // The relax pass begins with the other half of four points: over both passes neither half comes
            // first, and a box that lands flat is hardly tilted. Which point is the first of all differs from
            // contact to contact (see the narrow phase).
            let i = if soft.is_some() || P < 4 { k } else { k ^ 2 };
            let point = self.points[i];
            let (ra, rb) = (point.anchor, point.anchor - self.offset);
            let (ma, mb) = (ra.cross(n), rb.cross(n));
            let moved = shift + qb.shift_along(rb, mb, n) - qa.shift_along(ra, ma, n);
            let s = point.separation + moved;
            let apart = N::ZERO.lt(s);
            let (bias, mass_scale, impulse_scale) = match soft {
                Some(k) => (
                    N::select(apart, s * inv_h, (k.mass_scale * k.bias_rate * s).max(slowest)),
                    N::select(apart, N::ONE, k.mass_scale),
                    N::select(apart, N::ZERO, k.impulse_scale),
                ),
                None => (N::select(apart, s * inv_h, N::ZERO), N::ONE, N::ZERO),
            };
            let vn = pair.along(n, [ma, mb]);
            let change = point.mass * (mass_scale * vn + bias) + impulse_scale * point.impulse;
            let mut new = (point.impulse - change).max(N::ZERO);
            if let Some(e) = restitution {
                let fast = vn.lt(N::splat(-params.restitution_threshold));
                let free = N::and(apart, point.impulse.eq(N::ZERO));
                new = N::select(N::and(N::and(fast, free), N::ZERO.lt(e)), N::ZERO, new);
            }
            let delta = new - point.impulse;
            self.points[i].impulse = new;
            self.push(pair, n * delta, [ma * delta, mb * delta]);
        }
    }

    /// The friction centre from either body's centre of mass.
    #[inline(always)]
    pub(super) fn surface_arms(&self) -> [Vector<N>; 2] {
        [self.center, self.center - self.offset - self.normal * self.rounding]
    }

    /// How fast B's surface slides over A's at the friction centre, less the velocity it is driven to.
    #[inline(always)]
    fn slip(&self, pair: &Pair<N>, frame: &TangentFrame<N>) -> Tangent<N> {
        let [ra, rb] = self.surface_arms();
        let relative = pair.v[1] + pair.w[1].cross(rb) - pair.v[0] - pair.w[0].cross(ra);
        frame.project(relative) - self.surface_velocity
    }

    /// One friction row at the friction centre, limited by μ times the sum of the normal impulses, and
    /// the twist row.
    ///
    /// The impulses of the solve pass are too large by what pushed overlap out. So much of each is left out as
    /// would undo the velocity at which its point parts, which is about what the relax pass is going to do.
    #[inline(always)]
    fn solve_friction(&mut self, pair: &mut Pair<N>) {
        let n = self.normal;
        let frame = TangentFrame::new(n);
        let mut impulses = [N::ZERO; P];
        for i in 0..P {
            impulses[i] = self.points[i].impulse;
        }
        self.twist.solve(n, self.friction, impulses, self.inv_inertia, &mut pair.w);

        let mut sum = N::ZERO;
        for impulse in impulses {
            sum += impulse;
        }
        let [ra, rb] = self.surface_arms();
        let slip = self.slip(pair, &frame);
        let new = (self.tangent_impulse - self.tangent_mass.apply(slip)).clamp_length(self.friction * sum);
        let impulse = frame.expand(new - self.tangent_impulse);
        self.tangent_impulse = new;
        self.push(pair, impulse, [ra.cross(impulse), rb.cross(impulse)]);
    }

    /// The impact pass: points that close within this substep, and faster than the threshold, part again
    /// before any other pass sees them, as if they had met at the right time within it. Returns whether any
    /// did.
    ///
    /// # Safety
    /// No other thread reads or writes the row's bodies that may be written, nor writes the others.
    #[inline(always)]
    pub(super) unsafe fn impact(
        &mut self,
        rows: &RowView<BodyRow>,
        bounce: &mut RestitutionRow<N, P>,
        params: &SubstepParams,
    ) -> bool {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.ids) };
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
        self.collide(&mut pair, bounce, &targets, &moments);
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

    /// Gives each point its target velocity along the normal, where that is not 0, by an impulse that pushes
    /// only, and then the friction that goes with it.
    #[inline(always)]
    fn collide(
        &mut self,
        pair: &mut Pair<N>,
        bounce: &mut RestitutionRow<N, P>,
        targets: &[N; P],
        moments: &[[Angular<N>; 2]; P],
    ) {
        let n = self.normal;
        let mut impulses = [N::ZERO; P];
        // Points of one manifold share the impact: from a few sweeps, to and fro, none comes first.
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
    }

    /// The restitution pass: points that approached faster than the threshold and pushed leave with e
    /// times the approach speed. What the impact pass has seen is done with.
    ///
    /// # Safety
    /// No other thread reads or writes the row's bodies that may be written, nor writes the others.
    #[inline(always)]
    pub(super) unsafe fn restitute(
        &mut self,
        rows: &RowView<BodyRow>,
        bounce: &mut RestitutionRow<N, P>,
        params: &SubstepParams,
    ) {
        // SAFETY: by the contract.
        let before = unsafe { Pair::load(rows, &self.ids) };
        let mut pair = before;
        let n = self.normal;
        let threshold = N::splat(-params.restitution_threshold);
        for i in 0..P {
            let point = self.points[i];
            let (ma, mb) = (point.anchor.cross(n), (point.anchor - self.offset).cross(n));
            let vn = pair.along(n, [ma, mb]);
            let target = bounce.restitution * bounce.approach[i];
            let new = (point.impulse - point.mass * (vn + target)).max(N::ZERO);
            let hit = N::and(bounce.approach[i].lt(threshold), N::ZERO.lt(bounce.max_impulse[i]));
            let hit = N::and(hit, N::ZERO.lt(bounce.restitution));
            let new = N::select(hit, new, point.impulse);
            let delta = new - point.impulse;
            self.points[i].impulse = new;
            bounce.max_impulse[i] = bounce.max_impulse[i].max(new);
            self.push(&mut pair, n * delta, [ma * delta, mb * delta]);
        }
        // SAFETY: by the contract.
        unsafe { pair.or_where_not(N::ZERO.lt(bounce.restitution), before).store(rows, &self.ids) };
    }
}

impl<N: Lane, const P: usize> RestitutionRow<N, P> {
    /// What becomes of a point that meets within a substep: the speed at which it parts, and by how much
    /// closer it is at the substep's end than that speed would take it, because it meets only after
    /// `gap` / `speed`. `approach` is the speed before the substep's accelerations, `speed` the one after.
    ///
    /// Symplectic Euler keeps E = ½ v² + g y − ½ g h v of a free fall exactly (v upward). The speed w is the
    /// one that makes E after the substep, at y = w (h − t), e² times what it was before: the rebound is e²
    /// of the height at any step length, and nothing is gained.
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
