//! One contact manifold as solver rows, written once for 2D and 3D, one lane or many.

use super::{BodyRow, InvMass, RowView, Softness, SubstepParams, Twist};
use crate::math::{Angular, Ids, InvInertia, Lane, Tangent, TangentFrame, TangentMass, Vector};

/// One point of a manifold.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct PointRow<N> {
    /// From body A's centre of mass when the step begins; from body B's it is this less the row's offset.
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
    /// From A's to B's centre of mass when the anchors were found.
    pub offset: Vector<N>,
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

/// What only the restitution pass needs, apart from the rows that every pass sweeps.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct RestitutionRow<N: Lane, const P: usize> {
    /// The mixed coefficient of restitution.
    pub restitution: N,
    /// The normal velocity of each point when the step began, m/s.
    pub approach: [N; P],
    /// The largest impulse of each point so far in the step, N·s.
    pub max_impulse: [N; P],
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
        Self { restitution: N::ZERO, approach: [N::ZERO; P], max_impulse: [N::ZERO; P] }
    }
}

/// The velocities of a row's two bodies.
#[derive(Clone, Copy)]
struct Pair<N> {
    v: [Vector<N>; 2],
    w: [Angular<N>; 2],
}

impl<N: Lane> Pair<N> {
    #[inline(always)]
    fn load(rows: &RowView<BodyRow>, ids: &[N::Ids; 2]) -> Self {
        let (va, wa) = BodyRow::gather_velocity::<N>(rows, &ids[0]);
        let (vb, wb) = BodyRow::gather_velocity::<N>(rows, &ids[1]);
        Self { v: [va, vb], w: [wa, wb] }
    }

    #[inline(always)]
    fn store(&self, rows: &RowView<BodyRow>, ids: &[N::Ids; 2]) {
        BodyRow::scatter_velocity::<N>(rows, &ids[0], self.v[0], self.w[0]);
        BodyRow::scatter_velocity::<N>(rows, &ids[1], self.v[1], self.w[1]);
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
    #[inline(always)]
    pub fn warm_start(&self, rows: &RowView<BodyRow>) {
        let mut pair = Pair::load(rows, &self.ids);
        // All impulses of the manifold as one impulse and one moment for each body.
        let mut impulse = TangentFrame::new(self.normal).expand(self.tangent_impulse);
        let mut moments = [self.center.cross(impulse), (self.center - self.offset).cross(impulse)];
        for point in &self.points {
            let p = self.normal * point.impulse;
            impulse += p;
            moments[0] += point.anchor.cross(p);
            moments[1] += (point.anchor - self.offset).cross(p);
        }
        self.push(&mut pair, impulse, moments);
        self.twist.warm_start(self.normal, self.inv_inertia, &mut pair.w);
        pair.store(rows, &self.ids);
    }

    /// The soft-bias pass: non-penetration with position error fed back.
    #[inline(always)]
    pub fn solve(&mut self, rows: &RowView<BodyRow>, params: &SubstepParams) {
        let mut pair = Pair::load(rows, &self.ids);
        let immovable = N::or(self.inv_mass[0].is_zero(), self.inv_mass[1].is_zero());
        let soft = SoftLanes::select(immovable, &params.stiff, &params.soft);
        self.solve_normals(rows, &mut pair, params, Some(soft));
        pair.store(rows, &self.ids);
    }

    /// The relax pass: non-penetration without bias, then friction.
    #[inline(always)]
    pub fn relax(&mut self, rows: &RowView<BodyRow>, params: &SubstepParams) {
        let mut pair = Pair::load(rows, &self.ids);
        self.solve_normals(rows, &mut pair, params, None);
        self.solve_friction(&mut pair);
        pair.store(rows, &self.ids);
    }

    /// Notes the impulses that the restitution pass looks back on.
    #[inline(always)]
    pub fn note_impulses(&self, bounce: &mut RestitutionRow<N, P>) {
        for (max, point) in bounce.max_impulse.iter_mut().zip(&self.points) {
            *max = max.max(point.impulse);
        }
    }

    /// One normal row a point: λ' = max(λ − m (k_m (v_n + b)) − k_i λ, 0), where b is s/h while the
    /// point is apart (it may close exactly that far), the soft bias where it overlaps and `soft` is
    /// given, else 0.
    #[inline(always)]
    fn solve_normals(
        &mut self,
        rows: &RowView<BodyRow>,
        pair: &mut Pair<N>,
        params: &SubstepParams,
        soft: Option<SoftLanes<N>>,
    ) {
        let (pa, qa) = BodyRow::gather_delta::<N>(rows, &self.ids[0]);
        let (pb, qb) = BodyRow::gather_delta::<N>(rows, &self.ids[1]);
        let n = self.normal;
        let (inv_h, slowest) = (N::splat(params.inv_h), -self.push_speed);
        let shift = (pb - pa).dot(n);
        for k in 0..P {
            // The relax pass takes the points in the reverse order: over both passes no point comes first,
            // and a box that lands flat is hardly tilted by it.
            let i = if soft.is_some() { k } else { P - 1 - k };
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
            let vn = (pair.v[1] - pair.v[0]).dot(n) + pair.w[1].dot(mb) - pair.w[0].dot(ma);
            let change = point.mass * (mass_scale * vn + bias) + impulse_scale * point.impulse;
            let new = (point.impulse - change).max(N::ZERO);
            let delta = new - point.impulse;
            self.points[i].impulse = new;
            self.push(pair, n * delta, [ma * delta, mb * delta]);
        }
    }

    /// One friction row at the friction centre, limited by μ times the sum of the normal impulses, and
    /// the twist row.
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
        let (ra, rb) = (self.center, self.center - self.offset);
        let relative = pair.v[1] + pair.w[1].cross(rb) - pair.v[0] - pair.w[0].cross(ra);
        let slip = frame.project(relative) - self.surface_velocity;
        let new = (self.tangent_impulse - self.tangent_mass.apply(slip)).clamp_length(self.friction * sum);
        let impulse = frame.expand(new - self.tangent_impulse);
        self.tangent_impulse = new;
        self.push(pair, impulse, [ra.cross(impulse), rb.cross(impulse)]);
    }

    /// The restitution pass: points that approached faster than the threshold and pushed leave with e
    /// times the approach speed.
    #[inline(always)]
    pub fn restitute(
        &mut self,
        rows: &RowView<BodyRow>,
        bounce: &mut RestitutionRow<N, P>,
        params: &SubstepParams,
    ) {
        let mut pair = Pair::load(rows, &self.ids);
        let n = self.normal;
        let threshold = N::splat(-params.restitution_threshold);
        for i in 0..P {
            let point = self.points[i];
            let (ma, mb) = (point.anchor.cross(n), (point.anchor - self.offset).cross(n));
            let vn = (pair.v[1] - pair.v[0]).dot(n) + pair.w[1].dot(mb) - pair.w[0].dot(ma);
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
        pair.store(rows, &self.ids);
    }
}

/// [`Softness`], chosen lane by lane.
#[derive(Clone, Copy)]
struct SoftLanes<N> {
    bias_rate: N,
    mass_scale: N,
    impulse_scale: N,
}

impl<N: Lane> SoftLanes<N> {
    #[inline(always)]
    fn select(mask: N::Mask, a: &Softness, b: &Softness) -> Self {
        Self {
            bias_rate: N::select(mask, N::splat(a.bias_rate), N::splat(b.bias_rate)),
            mass_scale: N::select(mask, N::splat(a.mass_scale), N::splat(b.mass_scale)),
            impulse_scale: N::select(mask, N::splat(a.impulse_scale), N::splat(b.impulse_scale)),
        }
    }
}
