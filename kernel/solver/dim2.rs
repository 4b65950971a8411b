//! Parts of rows that depend on the dimension: memory layout of bodies, and twist friction. `dim3.rs`
//! exports the same names.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::RowView;
use crate::math::{Angular, InvInertia, Lane, Quad, Rot, Tangent, TangentMass, Vector};

/// A body during the solver stages: velocity, and displacement in this step. 32 bytes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct BodyRow {
    /// v.x, v.y, ω, unused.
    velocity: Quad,
    /// Δx, Δy, cos Δθ, sin Δθ.
    delta: Quad,
}

/// The part of an angular velocity about a contact's normal: none in 2D.
#[inline(always)]
pub(super) fn about<N: Lane>(_: Vector<N>, _: Angular<N>) -> Angular<N> {
    Angular::ZERO
}

/// Inverse mass and inverse inertia of a body, in world axes.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
pub struct MassRow {
    /// 1/m, 1/I, unused, unused.
    quad: Quad,
}

impl BodyRow {
    /// At rest, without displacement.
    pub const REST: Self = Self { velocity: Quad([0.0; 4]), delta: Quad([0.0, 0.0, 1.0, 0.0]) };

    /// A body with a velocity, without displacement.
    pub fn new(linear: Vector, angular: Angular) -> Self {
        let mut row = Self::REST;
        row.set_velocity(linear, angular);
        row
    }
    /// The velocity, m/s and rad/s.
    #[inline]
    pub fn velocity(&self) -> (Vector, Angular) {
        let [x, y, z, _] = self.velocity.0;
        (Vector { x, y }, Angular { z })
    }
    /// Sets the velocity, m/s and rad/s.
    #[inline]
    pub fn set_velocity(&mut self, linear: Vector, angular: Angular) {
        self.velocity.0 = [linear.x, linear.y, angular.z, 0.0];
    }
    /// Displacement and rotation since the start of the step.
    #[inline]
    pub fn delta(&self) -> (Vector, Rot) {
        let [x, y, cos, sin] = self.delta.0;
        (Vector { x, y }, Rot { cos, sin })
    }
    /// Whether the body was displaced or rotated since the start of the step.
    #[inline]
    pub fn is_moved(&self) -> bool {
        self.delta() != (Vector::ZERO, Rot::IDENTITY)
    }
    /// Sets displacement and rotation since the start of the step.
    #[inline]
    pub fn set_delta(&mut self, position: Vector, rotation: Rot) {
        self.delta.0 = [position.x, position.y, rotation.cos, rotation.sin];
    }

    /// Multiplies the velocity by factors, and adds accelerations over `h` seconds.
    #[inline(always)]
    pub(super) fn accelerate(&mut self, [linear, angular]: [f32; 2], (a, w): (Vector, Angular), h: f32) {
        self.velocity = self.velocity * Quad([linear, linear, angular, 0.0]);
        self.velocity += Quad([a.x, a.y, w.z, 0.0]) * Quad([h; 4]);
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
        let [x, y, z, _] = N::gather(ids, |id| unsafe { &rows.get(id).velocity });
        (Vector { x, y }, Angular { z })
    }
    /// Loads displacement and rotation in this step, one body per lane.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes these rows.
    #[inline(always)]
    pub(super) unsafe fn gather_delta<N: Lane>(rows: &RowView<Self>, ids: &N::Ids) -> (Vector<N>, Rot<N>) {
        // SAFETY: by the contract; the reference does not outlive the load.
        let [x, y, cos, sin] = N::gather(ids, |id| unsafe { &rows.get(id).delta });
        (Vector { x, y }, Rot { cos, sin })
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
        let values = [v.x, v.y, w.z, N::ZERO];
        // SAFETY: by the contract.
        unsafe { rows.scatter(values, ids, rows.are_writable(ids), |row, quad| row.velocity = quad) };
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
        N::scatter([v.x, v.y, w.z, N::ZERO], ids, |id, quad| unsafe {
            rows.put(id, |row| row.velocity += quad);
        });
    }
    /// Stores displacement and rotation in this step, one body per lane, in writable rows only.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the writable rows among these.
    #[inline(always)]
    pub(super) unsafe fn scatter_delta<N: Lane>(rows: &RowView<Self>, ids: &N::Ids, p: Vector<N>, q: Rot<N>) {
        let values = [p.x, p.y, q.cos, q.sin];
        // SAFETY: by the contract.
        unsafe { rows.scatter(values, ids, rows.are_writable(ids), |row, quad| row.delta = quad) };
    }
}

/// During a substep the velocity of a body before its impulses, after it the velocity change by them. 16
/// bytes.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
pub(super) struct GainRow {
    /// v.x, v.y, ω, unused.
    velocity: Quad,
}

impl GainRow {
    /// Stores the current velocity of a body. If `adds`, the last gain is then added to the body's
    /// velocity.
    #[inline(always)]
    pub(super) fn begin(&mut self, row: &mut BodyRow, adds: bool) {
        let before = row.velocity;
        if adds {
            row.velocity += self.velocity;
        }
        self.velocity = before;
    }
    /// Stores the velocity change of a body since [`begin`](Self::begin).
    #[inline(always)]
    pub(super) fn end(&mut self, row: &BodyRow) {
        let mut now = row.velocity;
        now -= self.velocity;
        self.velocity = now;
    }
    /// Adds a velocity.
    pub(super) fn add(&mut self, linear: Vector, angular: Angular) {
        self.velocity += Quad([linear.x, linear.y, angular.z, 0.0]);
    }
    /// Adds nonzero changes to the angular velocities of gains, one body per lane, in writable rows only.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the writable rows among these.
    #[inline(always)]
    pub(super) unsafe fn add_angular<N: Lane>(rows: &RowView<Self>, ids: &N::Ids, w: Angular<N>) {
        // SAFETY: by the contract.
        N::scatter([N::ZERO, N::ZERO, w.z, N::ZERO], ids, |id, quad| unsafe {
            if quad != Quad::default() {
                rows.put(id, |row| row.velocity += quad);
            }
        });
    }
}

impl MassRow {
    /// Takes the inverse mass, 1/kg, and the inverse inertia in world axes. Zeros make the body immovable.
    pub fn new(inv_mass: f32, inv_inertia: InvInertia) -> Self {
        Self { quad: Quad([inv_mass, inv_inertia.zz, 0.0, 0.0]) }
    }
    /// The inverse mass, 1/kg.
    pub fn inv_mass(&self) -> f32 {
        self.quad.0[0]
    }
    /// The inverse inertia in world axes.
    pub fn inv_inertia(&self) -> InvInertia {
        InvInertia { zz: self.quad.0[1] }
    }
    /// Rotates the inertia: no change in 2D.
    pub(super) fn turn(&mut self, _by: Angular) {}
    /// Loads masses, one body per lane.
    #[inline(always)]
    pub(super) fn gather<N: Lane>(rows: &[Self], ids: &N::Ids) -> (N, InvInertia<N>) {
        let [inv_mass, zz, ..] = N::gather(ids, |id| &rows[id as usize].quad);
        (inv_mass, InvInertia { zz })
    }
}

/// Torsional friction about the contact normal: none in 2D, and no bytes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Twist<N, const P: usize>(core::marker::PhantomData<N>);

impl<N: Lane, const P: usize> Twist<N, P> {
    /// Computes the effective mass: nothing in 2D.
    #[inline(always)]
    pub(super) fn prepare(
        &mut self,
        _normal: Vector<N>,
        _center: Vector<N>,
        _anchors: [Vector<N>; P],
        _patch: N,
        _inertia: [InvInertia<N>; 2],
    ) {
    }
    /// Applies the accumulated impulse: nothing in 2D.
    #[inline(always)]
    pub(super) fn warm_start(
        &self,
        _normal: Vector<N>,
        _inertia: [InvInertia<N>; 2],
        _w: &mut [Angular<N>; 2],
    ) {
    }
    /// The limits of sliding and of torsional friction: in 2D sliding has the whole limit.
    #[inline(always)]
    pub(super) fn limits(
        &self,
        _normal: Vector<N>,
        limit: N,
        _impulses: [N; P],
        _sliding: (TangentMass<N>, Tangent<N>),
        _w: &[Angular<N>; 2],
    ) -> [N; 2] {
        [limit, N::ZERO]
    }
    /// Solves the row: nothing in 2D.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        _normal: Vector<N>,
        _limit: N,
        _inertia: [InvInertia<N>; 2],
        _w: &mut [Angular<N>; 2],
    ) {
    }
    /// Lane `i`: nothing in 2D.
    pub(super) fn lane<const Q: usize>(&self, _i: usize) -> Twist<f32, Q> {
        Twist::default()
    }
    /// Writes lane `i`: nothing in 2D.
    #[inline(always)]
    pub(super) fn set(&mut self, _i: usize, _one: &Twist<f32, P>) {}
    /// The accumulated impulse of lane `i`, N·m·s.
    pub(super) fn impulse(&self, _i: usize) -> f32 {
        0.0
    }
    /// The accumulated impulse times the relative spin, J: zero in 2D.
    pub(super) fn power(&self, _normal: Vector<N>, _w: &[Angular<N>; 2]) -> N {
        N::ZERO
    }
    /// Sets the accumulated impulse of lane `i`, N·m·s.
    pub(super) fn set_impulse(&mut self, _i: usize, _value: f32) {}
}

/// Rolling resistance: an impulse of at most `limit` against the relative angular velocity. It is not
/// accumulated. The limit fades where `scale` times that velocity is above 1, and is 0 from 2 on.
#[inline(always)]
pub(super) fn resist_rolling<N: Lane>(
    _normal: Vector<N>,
    scale: N,
    limit: N,
    inertia: [InvInertia<N>; 2],
    w: &mut [Angular<N>; 2],
) {
    let speed = w[1].z - w[0].z;
    let limit = limit * (N::splat(2.0) - speed.max(-speed) * scale).max(N::ZERO).min(N::ONE);
    let k = inertia[0].zz + inertia[1].zz;
    let mass = N::select(N::ZERO.lt(k), N::ONE / k, N::ZERO);
    let impulse = (mass * speed).max(-limit).min(limit);
    w[0].z += inertia[0].zz * impulse;
    w[1].z -= inertia[1].zz * impulse;
}
