//! One contact manifold as solver rows, for 2D and 3D, one lane or several.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::pair::{Pair, SoftLanes};
use super::{BodyRow, GainRow, InvMass, RowView, SubstepParams, Twist};
use crate::math::{Angular, DIM, Ids, InvInertia, Lane, Tangent, TangentFrame, TangentMass, Vector};

/// One point of a manifold.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct PointRow<N> {
    /// Vector from A's centre of mass to A's core (see [`Shape::radius`](crate::shape::Shape::radius)), at
    /// the start of the step. The vector from B's centre of mass to B's core is `anchor` minus the row's
    /// offset.
    pub anchor: Vector<N>,
    /// Separation at the start of the step, in metres.
    pub separation: N,
    /// Separation after the last substep, in metres.
    pub gap: N,
    /// The effective mass along the normal, kg.
    pub mass: N,
    /// The accumulated normal impulse, N·s, ≥ 0.
    pub impulse: N,
}

/// Manifolds of `N::WIDTH` contacts with at most `P` points each.
///
/// Anchors and normals are constant over the step. Separations follow the bodies' exact motion. Absent
/// points have zero mass.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct ContactRow<N: Lane, M, const P: usize> {
    /// Body rows A and B.
    pub ids: [N::Ids; 2],
    /// Inverse mass, 1/kg: one number, or one per axis for bodies with locked axes.
    pub inv_mass: [M; 2],
    /// Inverse inertia in world axes.
    pub inv_inertia: [InvInertia<N>; 2],
    /// Normal from A to B.
    pub normal: Vector<N>,
    /// Anchor from A's centre of mass minus the anchor from B's.
    pub offset: Vector<N>,
    /// Sum of the radii of both shapes: the distances of their surfaces from their cores, in metres.
    pub radius: N,
    /// Lever of rolling resistance, in metres.
    pub roll_lever: N,
    /// The mixed friction coefficient.
    pub friction: N,
    /// Maximum speed at which overlap is pushed out, m/s.
    pub push_speed: N,
    /// Target velocity of B's surface relative to A's, in the tangent space, m/s.
    pub surface_velocity: Tangent<N>,
    /// The friction row's anchor from A.
    pub center: Vector<N>,
    /// The friction row's effective mass.
    pub tangent_mass: TangentMass<N>,
    /// The accumulated friction impulse, N·s.
    pub tangent_impulse: Tangent<N>,
    /// Normal impulse by which friction has not been limited yet: impulses of the last relax pass minus
    /// impulses of the solve pass before it, N·s.
    pub owed: N,
    /// Torsional friction about the normal.
    pub twist: Twist<N, P>,
    /// The points.
    pub points: [PointRow<N>; P],
}

/// Data of split impulses, apart from the rows that every pass reads.
///
/// Decision: the impulses that push deep overlap out move bodies only. Before the relax pass they are
/// removed from the velocities, impulse by impulse, which conserves momentum. The relax pass would not
/// remove them by itself: it lowers an impulse only where bodies separate. Inside a crowd, where pushes
/// from all sides balance, they would add up over the substeps as in a compressed spring, and bodies at the
/// edge would be flung off. Approaching bodies are stopped as usual, by the unbiased part of the solve
/// pass.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct SplitImpulseRow<N: Lane, const P: usize> {
    /// 1 if a body of the contact overlaps another deeply, otherwise 0.
    pub deep: N,
    /// Share of the impulses for the warm start.
    pub warm: N,
    /// Impulse of each point before the solve pass, N·s.
    pub before: [N; P],
}

const _: () = {
    use crate::math::F32x4;
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
            radius: N::ZERO,
            roll_lever: N::ZERO,
            friction: N::ZERO,
            push_speed: N::ZERO,
            surface_velocity: Tangent::ZERO,
            center: Vector::ZERO,
            tangent_mass: TangentMass::default(),
            tangent_impulse: Tangent::ZERO,
            owed: N::ZERO,
            twist: Twist::default(),
            points: [PointRow::default(); P],
        }
    }
}

impl<N: Lane, const P: usize> Default for SplitImpulseRow<N, P> {
    fn default() -> Self {
        Self { deep: N::ZERO, warm: N::ONE, before: [N::ZERO; P] }
    }
}

impl<N: Lane, M: InvMass<N>, const P: usize> ContactRow<N, M, P> {
    /// Applies `impulse` to both bodies. `moments` are its moments about their centres of mass.
    #[inline(always)]
    pub(super) fn push(&self, pair: &mut Pair<N>, impulse: Vector<N>, moments: [Angular<N>; 2]) {
        pair.v[0] -= self.inv_mass[0].apply(impulse);
        pair.w[0] -= self.inv_inertia[0].apply(moments[0]);
        pair.v[1] += self.inv_mass[1].apply(impulse);
        pair.w[1] += self.inv_inertia[1].apply(moments[1]);
    }

    /// Applies the accumulated impulses.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the row's writable bodies, or writes the
    /// others.
    #[inline(always)]
    pub(super) unsafe fn warm_start(&self, rows: &RowView<BodyRow>) {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.ids) };
        // Sum of all impulses of the manifold: one impulse, and one moment per body.
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

    /// The solve pass: non-penetration with soft bias. Gaps are up to date: bodies have not moved since the
    /// last relax pass, and where blows moved them, gaps were [measured](Self::measure) again.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the row's writable bodies, or writes the
    /// others.
    #[inline(always)]
    pub(super) unsafe fn solve(&mut self, rows: &RowView<BodyRow>, params: &SubstepParams) {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.ids) };
        let immovable = N::or(self.inv_mass[0].is_zero(), self.inv_mass[1].is_zero());
        let soft = SoftLanes::select(immovable, &params.stiff, &params.soft);
        self.solve_normals(&mut pair, params, Some(soft), None);
        // SAFETY: by the contract.
        unsafe { pair.store(rows, &self.ids) };
    }

    /// The relax pass: friction, then non-penetration without bias.
    ///
    /// Friction is solved between the two sweeps over normal rows, of the solve pass and of this one. One
    /// warm-started sweep per substep does not reach the solution but oscillates about it, and some orders
    /// amplify the oscillation. With friction last, a pyramid of base 16 at rest reached 0.2 m/s in 50 s;
    /// with this order it comes to rest.
    ///
    /// Where `watched` is positive, points without an impulse that close fast are not slowed down, even if
    /// rotation made them touch: they are left to the next blow.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the row's writable bodies, or writes the
    /// others.
    #[inline(always)]
    pub(super) unsafe fn relax(
        &mut self,
        rows: &RowView<BodyRow>,
        gains: &RowView<GainRow>,
        params: &SubstepParams,
        watched: Option<N>,
    ) {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.ids) };
        // SAFETY: by the contract.
        let carried = unsafe { self.carried(rows, &pair, params) };
        let pressure = self.pressure();
        let load = (pressure + self.owed).max(N::ZERO);
        self.solve_friction(&mut pair, carried, load);
        // SAFETY: by the contract.
        unsafe { self.resist_rolling(&mut pair, gains, load, params) };
        // SAFETY: by the contract.
        unsafe { self.measure(rows) };
        self.solve_normals(&mut pair, params, None, watched);
        self.owed = self.pressure() - pressure;
        // SAFETY: by the contract.
        unsafe { pair.store(rows, &self.ids) };
    }

    /// The sum of the normal impulses, N·s.
    #[inline(always)]
    pub(super) fn pressure(&self) -> N {
        let mut sum = N::ZERO;
        for point in &self.points {
            sum += point.impulse;
        }
        sum
    }

    /// Scales the impulses to the row's share for the warm start.
    #[inline(always)]
    pub(super) fn scale_impulses(&mut self, split: &SplitImpulseRow<N, P>) {
        for point in &mut self.points {
            point.impulse = point.impulse * split.warm;
        }
        self.owed = self.owed * split.warm;
    }

    /// Saves the impulses that [`undo_split`](Self::undo_split) restores.
    #[inline(always)]
    pub(super) fn save_impulses(&self, split: &mut SplitImpulseRow<N, P>) {
        for (before, point) in split.before.iter_mut().zip(&self.points) {
            *before = point.impulse;
        }
    }

    /// Removes the impulses of the solve pass from the velocities of deeply overlapping bodies, after
    /// positions were integrated with them.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the row's writable bodies, or writes the
    /// others.
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

    /// Adds the impulses of a substep to their sums over the step.
    #[inline(always)]
    pub(super) fn sum_impulses(&self, sum: &mut [N; P]) {
        for (sum, point) in sum.iter_mut().zip(&self.points) {
            *sum += point.impulse;
        }
    }

    /// Computes the gaps.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the row.
    #[inline(always)]
    pub(super) unsafe fn measure(&mut self, rows: &RowView<BodyRow>) {
        // SAFETY: by the contract.
        let [(pa, qa), (pb, qb)] = unsafe {
            [BodyRow::gather_delta::<N>(rows, &self.ids[0]), BodyRow::gather_delta::<N>(rows, &self.ids[1])]
        };
        let n = self.normal;
        let shift = (pb - pa).dot(n);
        for point in &mut self.points {
            let (ra, rb) = (point.anchor, point.anchor - self.offset);
            let moved = shift + qb.shift_along(rb, rb.cross(n), n) - qa.shift_along(ra, ra.cross(n), n);
            point.gap = point.separation + moved;
        }
    }

    /// One normal row per point: λ' = max(λ − m (k_m v_n + b) − k_i λ, 0). b is s/h for a separated point
    /// (it may close exactly that far); for an overlapping point it is the soft bias times k_m, limited by
    /// the push speed, if `soft` is given, otherwise 0.
    #[inline(always)]
    fn solve_normals(
        &mut self,
        pair: &mut Pair<N>,
        params: &SubstepParams,
        soft: Option<SoftLanes<N>>,
        watched: Option<N>,
    ) {
        let n = self.normal;
        let (inv_h, slowest) = (N::splat(params.inv_h), -self.push_speed);
        // All points push along one normal, so they share one relative velocity of the centres of mass.
        let mut approach = (pair.v[1] - pair.v[0]).dot(n);
        let yielding = self.inv_mass[0].along(n) + self.inv_mass[1].along(n);
        let mut pushed = N::ZERO;
        for k in 0..P {
            // The relax pass begins with the other half of four points. Over both passes neither half comes
            // first, and a box that lands flat is hardly tilted. The first point differs from contact to
            // contact (see the narrow phase).
            let i = if soft.is_some() || P < 4 { k } else { k ^ 2 };
            let point = self.points[i];
            let (ma, mb) = (point.anchor.cross(n), (point.anchor - self.offset).cross(n));
            let s = point.gap;
            let apart = N::ZERO.lt(s);
            let (bias, mass_scale, impulse_scale) = match soft {
                Some(k) => (
                    N::select(apart, s * inv_h, (k.mass_scale * k.bias_rate * s).max(slowest)),
                    N::select(apart, N::ONE, k.mass_scale),
                    N::select(apart, N::ZERO, k.impulse_scale),
                ),
                None => (N::select(apart, s * inv_h, N::ZERO), N::ONE, N::ZERO),
            };
            let vn = approach + pair.w[1].dot(mb) - pair.w[0].dot(ma);
            let change = point.mass * (mass_scale * vn + bias) + impulse_scale * point.impulse;
            let mut new = (point.impulse - change).max(N::ZERO);
            if let Some(watched) = watched {
                let fast = vn.lt(N::splat(-params.blow_speed));
                let free = N::and(point.impulse.eq(N::ZERO), N::ZERO.lt(watched));
                new = N::select(N::and(fast, free), N::ZERO, new);
            }
            let delta = new - point.impulse;
            self.points[i].impulse = new;
            approach += yielding * delta;
            pushed += delta;
            pair.w[0] -= self.inv_inertia[0].apply(ma * delta);
            pair.w[1] += self.inv_inertia[1].apply(mb * delta);
        }
        pair.v[0] -= self.inv_mass[0].apply(n * pushed);
        pair.v[1] += self.inv_mass[1].apply(n * pushed);
    }

    /// Computes the effective mass of friction.
    #[inline(always)]
    pub(super) fn weigh_friction(&mut self, frame: &TangentFrame<N>) {
        let [ra, rb] = self.surface_arms();
        let arms = [(self.inv_inertia[0], ra), (self.inv_inertia[1], rb)];
        let [m0, m1] = self.inv_mass;
        self.tangent_mass = frame.mass(m0.diagonal() + m1.diagonal(), arms);
    }

    /// The vectors from both centres of mass to the friction centre.
    #[inline(always)]
    pub(super) fn surface_arms(&self) -> [Vector<N>; 2] {
        [self.center, self.center - self.offset - self.normal * self.radius]
    }

    /// The shorter surface arm of the bodies that can rotate, in metres; 0 if neither can. The centre of
    /// mass of a static body is irrelevant for rolling.
    #[inline(always)]
    pub(super) fn rolling_arm(&self) -> N {
        let (far, arms) = (N::splat(f32::MAX), self.surface_arms());
        let mut shorter = far;
        for i in 0..2 {
            let turns = N::ZERO.lt(self.inv_inertia[i].trace());
            shorter = shorter.min(N::select(turns, arms[i].length(), far));
        }
        N::select(shorter.lt(far), shorter, N::ZERO)
    }

    /// Sliding velocity of B's surface over A's at the friction centre, minus the target velocity.
    #[inline(always)]
    pub(super) fn slip(&self, pair: &Pair<N>, frame: &TangentFrame<N>) -> Tangent<N> {
        let [ra, rb] = self.surface_arms();
        let relative = pair.v[1] + pair.w[1].cross(rb) - pair.v[0] - pair.w[0].cross(ra);
        frame.project(relative) - self.surface_velocity
    }
}
