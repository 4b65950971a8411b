//! Parts of rows that depend on the dimension: memory layout of bodies, and twist friction. `dim2.rs`
//! exports the same names.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::RowView;
use crate::math::{Angular, InvInertia, Lane, Quad, Rot, Tangent, TangentMass, Vector};
use crate::tuning::solver::SPUN;

/// A body during the solver stages: velocity, and displacement in this step. 64 bytes, one cache line.
/// Padding makes each part one load of four floats.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct BodyRow {
    /// v, unused.
    linear: Quad,
    /// ω, unused.
    angular: Quad,
    /// Δx, unused.
    position: Quad,
    /// Rotation in this step, as a quaternion.
    rotation: Quad,
}

/// The part of an angular velocity about a contact's normal.
#[inline(always)]
pub(super) fn about<N: Lane>(normal: Vector<N>, w: Angular<N>) -> Angular<N> {
    normal * normal.dot(w)
}

/// Inverse mass and inverse inertia of a body, in world axes.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub struct MassRow {
    /// 1/m, xx, yy, zz.
    diagonal: Quad,
    /// xy, xz, yz, unused.
    rest: Quad,
}

impl BodyRow {
    /// At rest, without displacement.
    pub const REST: Self = Self {
        linear: Quad([0.0; 4]),
        angular: Quad([0.0; 4]),
        position: Quad([0.0; 4]),
        rotation: Quad([0.0, 0.0, 0.0, 1.0]),
    };

    /// A body with a velocity, without displacement.
    pub fn new(linear: Vector, angular: Angular) -> Self {
        let mut row = Self::REST;
        row.set_velocity(linear, angular);
        row
    }
    /// The velocity, m/s and rad/s.
    #[inline]
    pub fn velocity(&self) -> (Vector, Angular) {
        let ([x, y, z, _], [a, b, c, _]) = (self.linear.0, self.angular.0);
        (Vector { x, y, z }, Vector { x: a, y: b, z: c })
    }
    /// Sets the velocity, m/s and rad/s.
    #[inline]
    pub fn set_velocity(&mut self, linear: Vector, angular: Angular) {
        self.linear.0 = [linear.x, linear.y, linear.z, 0.0];
        self.angular.0 = [angular.x, angular.y, angular.z, 0.0];
    }
    /// Displacement and rotation since the start of the step.
    #[inline]
    pub fn delta(&self) -> (Vector, Rot) {
        let ([x, y, z, _], [a, b, c, w]) = (self.position.0, self.rotation.0);
        (Vector { x, y, z }, Rot { x: a, y: b, z: c, w })
    }
    /// Whether the body was displaced or rotated since the start of the step.
    #[inline]
    pub fn is_moved(&self) -> bool {
        self.delta() != (Vector::ZERO, Rot::IDENTITY)
    }
    /// Sets displacement and rotation since the start of the step.
    #[inline]
    pub fn set_delta(&mut self, position: Vector, rotation: Rot) {
        self.position.0 = [position.x, position.y, position.z, 0.0];
        self.rotation.0 = [rotation.x, rotation.y, rotation.z, rotation.w];
    }

    /// Multiplies the velocity by factors, and adds accelerations over `h` seconds.
    #[inline(always)]
    pub(super) fn accelerate(&mut self, [linear, angular]: [f32; 2], (a, w): (Vector, Angular), h: f32) {
        self.linear = self.linear * Quad([linear; 4]);
        self.linear += Quad([a.x, a.y, a.z, 0.0]) * Quad([h; 4]);
        self.angular = self.angular * Quad([angular; 4]);
        self.angular += Quad([w.x, w.y, w.z, 0.0]) * Quad([h; 4]);
    }

    /// Loads velocities, one body per lane.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes these rows.
    #[inline(always)]
    pub(super) unsafe fn gather_velocity<N: Lane>(
        rows: &RowView<Self>,
        ids: &N::Ids,
    ) -> (Vector<N>, Angular<N>) {
        // SAFETY: by the contract; the reference does not outlive the load.
        let [x, y, z, _] = N::gather(ids, |id| unsafe { &rows.get(id).linear });
        // SAFETY: by the contract; the reference does not outlive the load.
        let [a, b, c, _] = N::gather(ids, |id| unsafe { &rows.get(id).angular });
        (Vector { x, y, z }, Vector { x: a, y: b, z: c })
    }
    /// Loads displacement and rotation in this step, one body per lane.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes these rows.
    #[inline(always)]
    pub(super) unsafe fn gather_delta<N: Lane>(rows: &RowView<Self>, ids: &N::Ids) -> (Vector<N>, Rot<N>) {
        // SAFETY: by the contract; the reference does not outlive the load.
        let [x, y, z, _] = N::gather(ids, |id| unsafe { &rows.get(id).position });
        // SAFETY: by the contract; the reference does not outlive the load.
        let [a, b, c, w] = N::gather(ids, |id| unsafe { &rows.get(id).rotation });
        (Vector { x, y, z }, Rot { x: a, y: b, z: c, w })
    }
    /// Stores velocities, one body per lane, in writable rows only.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the writable rows among these.
    #[inline(always)]
    pub(super) unsafe fn scatter_velocity<N: Lane>(
        rows: &RowView<Self>,
        ids: &N::Ids,
        v: Vector<N>,
        w: Angular<N>,
    ) {
        let all = rows.are_writable(ids);
        // SAFETY: by the contract.
        unsafe {
            rows.scatter([v.x, v.y, v.z, N::ZERO], ids, all, |row, quad| row.linear = quad);
            rows.scatter([w.x, w.y, w.z, N::ZERO], ids, all, |row, quad| row.angular = quad);
        }
    }
    /// Adds to velocities, one body per lane, in writable rows only. A body may be in several lanes.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the writable rows among these.
    #[inline(always)]
    pub(super) unsafe fn add_velocity<N: Lane>(
        rows: &RowView<Self>,
        ids: &N::Ids,
        v: Vector<N>,
        w: Angular<N>,
    ) {
        // SAFETY: by the contract.
        N::scatter([v.x, v.y, v.z, N::ZERO], ids, |id, quad| unsafe {
            rows.put(id, |row| row.linear += quad);
        });
        // SAFETY: by the contract.
        N::scatter([w.x, w.y, w.z, N::ZERO], ids, |id, quad| unsafe {
            rows.put(id, |row| row.angular += quad);
        });
    }
    /// Stores displacement and rotation in this step, one body per lane, in writable rows only.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the writable rows among these.
    #[inline(always)]
    pub(super) unsafe fn scatter_delta<N: Lane>(rows: &RowView<Self>, ids: &N::Ids, p: Vector<N>, q: Rot<N>) {
        let all = rows.are_writable(ids);
        // SAFETY: by the contract.
        unsafe {
            rows.scatter([p.x, p.y, p.z, N::ZERO], ids, all, |row, quad| row.position = quad);
            rows.scatter([q.x, q.y, q.z, q.w], ids, all, |row, quad| row.rotation = quad);
        }
    }
}

/// During a substep the velocity of a body before its impulses, after it the velocity change by them. 32
/// bytes.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub(super) struct GainRow {
    /// v, unused.
    linear: Quad,
    /// ω, unused.
    angular: Quad,
}

impl GainRow {
    /// Stores the current velocity of a body. If `adds`, the last gain is then added to the body's
    /// velocity.
    #[inline(always)]
    pub(super) fn begin(&mut self, row: &mut BodyRow, adds: bool) {
        let (linear, angular) = (row.linear, row.angular);
        if adds {
            row.linear += self.linear;
            row.angular += self.angular;
        }
        *self = Self { linear, angular };
    }
    /// Stores the velocity change of a body since [`begin`](Self::begin).
    #[inline(always)]
    pub(super) fn end(&mut self, row: &BodyRow) {
        let (mut linear, mut angular) = (row.linear, row.angular);
        linear -= self.linear;
        angular -= self.angular;
        *self = Self { linear, angular };
    }
    /// Adds a velocity.
    pub(super) fn add(&mut self, v: Vector, w: Angular) {
        self.linear += Quad([v.x, v.y, v.z, 0.0]);
        self.angular += Quad([w.x, w.y, w.z, 0.0]);
    }
    /// Adds nonzero changes to the angular velocities of gains, one body per lane, in writable rows only.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the writable rows among these.
    #[inline(always)]
    pub(super) unsafe fn add_angular<N: Lane>(rows: &RowView<Self>, ids: &N::Ids, w: Angular<N>) {
        // SAFETY: by the contract.
        N::scatter([w.x, w.y, w.z, N::ZERO], ids, |id, quad| unsafe {
            if quad != Quad::default() {
                rows.put(id, |row| row.angular += quad);
            }
        });
    }
}

impl MassRow {
    /// Takes the inverse mass, 1/kg, and the inverse inertia in world axes. Zeros make the body immovable.
    pub fn new(inv_mass: f32, i: InvInertia) -> Self {
        Self { diagonal: Quad([inv_mass, i.xx, i.yy, i.zz]), rest: Quad([i.xy, i.xz, i.yz, 0.0]) }
    }
    /// The inverse mass, 1/kg.
    pub fn inv_mass(&self) -> f32 {
        self.diagonal.0[0]
    }
    /// The inverse inertia in world axes.
    pub fn inv_inertia(&self) -> InvInertia {
        let ([_, xx, yy, zz], [xy, xz, yz, _]) = (self.diagonal.0, self.rest.0);
        InvInertia { xx, yy, zz, xy, xz, yz }
    }
    /// Rotates the inertia by a small rotation vector.
    pub(super) fn turn(&mut self, by: Angular) {
        let half = by * 0.5;
        let by = Rot { x: half.x, y: half.y, z: half.z, w: 1.0 }.normalized();
        *self = Self::new(self.inv_mass(), self.inv_inertia().rotated(by));
    }
    /// Loads masses, one body per lane.
    #[inline(always)]
    pub(super) fn gather<N: Lane>(rows: &[Self], ids: &N::Ids) -> (N, InvInertia<N>) {
        let [inv_mass, xx, yy, zz] = N::gather(ids, |id| &rows[id as usize].diagonal);
        let [xy, xz, yz, _] = N::gather(ids, |id| &rows[id as usize].rest);
        (inv_mass, InvInertia { xx, yy, zz, xy, xz, yz })
    }
}

/// The mean distance from the centre under even pressure, by number of points, as a share of the points'
/// distance: 1/2 for a line, 2/3 for a disc with points on its rim.
const EVEN: [f32; 5] = [0.0, 1.0, 1.0 / 2.0, 2.0 / 3.0, 2.0 / 3.0];

/// Torsional friction about the contact normal.
///
/// The angular row K = nᵀ (I_A⁻¹ + I_B⁻¹) n. Alone it is limited by T = μ Σ lᵢ λᵢ: each point resists with
/// its normal impulse λᵢ at a lever lᵢ. Together with sliding friction f, of limit F, its impulse τ is
/// limited by an ellipse (Howe and Cutkosky, "Practical Force-Motion Models for Sliding Manipulation",
/// 1996):
///
/// (f / F)² + (τ / T)² ≤ 1.
///
/// A contact that slips at u and spins at ω meets the impulses of the ellipse point whose outward normal is
/// (u, ω): with r = T / F these are f = F u / s and τ = T r ω / s, where s² = u² + r² ω². This f is half
/// too strong if spin dominates: a disc under even pressure has f = F u / (u⁴ + (1.5 r ω)⁴)^¼ within 2 % of
/// F, and ends both motions at once (`SPUN`).
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Twist<N, const P: usize> {
    levers: [N; P],
    mass: N,
    impulse: N,
}

impl<N: Lane, const P: usize> Default for Twist<N, P> {
    fn default() -> Self {
        Self { levers: [N::ZERO; P], mass: N::ZERO, impulse: N::ZERO }
    }
}

impl<N: Lane, const P: usize> Twist<N, P> {
    /// Computes the effective mass and the levers. `patch` is the lever of a single point by its contact
    /// patch, in metres.
    #[inline(always)]
    pub(super) fn prepare(
        &mut self,
        normal: Vector<N>,
        center: Vector<N>,
        anchors: [Vector<N>; P],
        patch: N,
        inertia: [InvInertia<N>; 2],
    ) {
        let k = normal.dot(inertia[0].apply(normal) + inertia[1].apply(normal));
        self.mass = N::select(N::ZERO.lt(k), N::ONE / k, N::ZERO);
        for (lever, anchor) in self.levers.iter_mut().zip(anchors) {
            *lever = (anchor - center).length() * N::splat(EVEN[P]) + patch;
        }
    }
    /// Applies the accumulated impulse.
    #[inline(always)]
    pub(super) fn warm_start(&self, normal: Vector<N>, inertia: [InvInertia<N>; 2], w: &mut [Angular<N>; 2]) {
        let impulse = normal * self.impulse;
        w[0] -= inertia[0].apply(impulse);
        w[1] += inertia[1].apply(impulse);
    }
    /// The limits of sliding and of torsional friction, which share `limit`, μ times the normal impulse.
    /// `mass` is the effective mass of sliding, and `stick` the impulse that stops it.
    #[inline(always)]
    pub(super) fn limits(
        &self,
        normal: Vector<N>,
        limit: N,
        impulses: [N; P],
        (mass, stick): (TangentMass<N>, Tangent<N>),
        w: &[Angular<N>; 2],
    ) -> [N; 2] {
        let (mut sum, mut levers) = (N::ZERO, N::ZERO);
        for (lever, impulse) in self.levers.iter().zip(impulses) {
            sum += impulse;
            levers += *lever * impulse;
        }
        let radius = N::select(N::ZERO.lt(sum), levers / sum, N::ZERO);
        let torque = limit * radius;
        let stop = self.impulse - self.mass * normal.dot(w[1] - w[0]);
        let turn = stop / radius.max(N::splat(f32::MIN_POSITIVE));
        let square = stick.x * stick.x + stick.y * stick.y + turn * turn;
        let slides = N::and((limit * limit).lt(square), N::ZERO.lt(radius));
        if !N::any(slides) {
            return [limit, torque];
        }
        let slip = mass.slip(stick).length();
        let spin = N::select(N::ZERO.lt(self.mass), radius * stop / self.mass, N::ZERO);
        let [u, w] = [slip * slip, spin * spin];
        let part = |speed: N, of: N| N::select(N::ZERO.lt(of), speed / of, N::ZERO);
        let slide = part(slip, (u * u + w * w * N::splat(SPUN)).sqrt().sqrt());
        let spin = part(spin.max(-spin), (u + w).sqrt());
        [N::select(slides, limit * slide, limit), N::select(slides, torque * spin, torque)]
    }
    /// Solves the row.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        normal: Vector<N>,
        limit: N,
        inertia: [InvInertia<N>; 2],
        w: &mut [Angular<N>; 2],
    ) {
        let speed = normal.dot(w[1] - w[0]);
        let new = (self.impulse - self.mass * speed).max(-limit).min(limit);
        let impulse = normal * (new - self.impulse);
        self.impulse = new;
        w[0] -= inertia[0].apply(impulse);
        w[1] += inertia[1].apply(impulse);
    }
    /// Lane `i`, with room for more points and without impulse.
    pub(super) fn lane<const Q: usize>(&self, i: usize) -> Twist<f32, Q> {
        let levers = core::array::from_fn(|k| self.levers.get(k).map_or(0.0, |lever| lever.get(i)));
        Twist { levers, mass: self.mass.get(i), impulse: 0.0 }
    }
    /// Writes lane `i`.
    #[inline(always)]
    pub(super) fn set(&mut self, i: usize, one: &Twist<f32, P>) {
        for k in 0..P {
            self.levers[k].set(i, one.levers[k]);
        }
        self.mass.set(i, one.mass);
        self.impulse.set(i, one.impulse);
    }
    /// The accumulated impulse of lane `i`, N·m·s.
    pub(super) fn impulse(&self, i: usize) -> f32 {
        self.impulse.get(i)
    }
    /// The accumulated impulse times the relative spin, J.
    pub(super) fn power(&self, normal: Vector<N>, w: &[Angular<N>; 2]) -> N {
        self.impulse * normal.dot(w[1] - w[0])
    }
    /// Sets the accumulated impulse of lane `i`, N·m·s.
    pub(super) fn set_impulse(&mut self, i: usize, value: f32) {
        self.impulse.set(i, value);
    }
}

/// Rolling resistance: an impulse of at most `limit` against the relative angular velocity across the
/// normal. It is not accumulated. The limit fades where `scale` times that velocity is above 1, and is 0
/// from 2 on.
#[inline(always)]
pub(super) fn resist_rolling<N: Lane>(
    normal: Vector<N>,
    scale: N,
    limit: N,
    inertia: [InvInertia<N>; 2],
    w: &mut [Angular<N>; 2],
) {
    let relative = w[1] - w[0];
    let rolling = relative - normal * relative.dot(normal);
    let speed = rolling.length();
    let limit = limit * (N::splat(2.0) - speed * scale).max(N::ZERO).min(N::ONE);
    // The trace is at least the largest eigenvalue, so the impulse does not reverse the rotation about any
    // axis.
    let k = inertia[0].trace() + inertia[1].trace();
    let mass = N::select(N::ZERO.lt(k), N::ONE / k, N::ZERO);
    let impulse = rolling * N::select(N::ZERO.lt(speed), mass.min(limit / speed), N::ZERO);
    w[0] += inertia[0].apply(impulse);
    w[1] -= inertia[1].apply(impulse);
}
