//! Rows of couplings: one limited sum of a coordinate at each of two bodies. The change of the sum within
//! the step is added to its start value, which is computed in `f64`, so that no whole turn is lost and
//! nothing drifts.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::super::batch::{Batch, Filling, SolverPass, SolverPasses, Sweep};
use super::super::input::Item;
use super::super::pair::Pair;
use super::super::{BodyRow, InvMass, MassRow, RowView, SubstepParams};
use super::block::Softening;
use super::coupling::{CouplingRecord, EndCoordinate};
use super::dim::{TURNING, angles};
use super::place::Masses;
use super::records::Records;
use super::row::{Hold, Stiffness};
use super::state::JointReaction;
use crate::contact::ManifoldsView;
use crate::data::Parts;
use crate::math::{Angular, Entry, Ids, Job, Lane, Rot, Vector};
use core::ops::Range;

/// One end of couplings, one coupling per lane.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct EndRow<N> {
    /// Weights of turn, shift and distance: the weight of the end's coordinate in the sum, and zeros for
    /// the others.
    turn: N,
    along: N,
    apart: N,
    /// Vector from the centre of mass to the anchor at the start of the step.
    arm: Vector<N>,
    /// Vector from the origin of the world frame to the anchor at the start of the step.
    from: Vector<N>,
    /// The body's frame at the start of the step, and the world frame.
    basis: Rot<N>,
    ground: Rot<N>,
    /// The distance or the angle at the start of the step.
    before: N,
    /// Rotation of the body since the start of the step, and the whole turns included in it.
    turned: N,
    turns: N,
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct CouplingRow<N: Lane> {
    ids: [N::Ids; 2],
    ends: [EndRow<N>; 2],
    masses: Masses<N>,
    /// The sum at the start of the step, minus the limit relative to which it is measured.
    start: N,
    limits: [N; 2],
    softening: Softening<N>,
    impulses: [N; 2],
    /// The impulse on B, and its moment about B's anchor.
    on_b: (Vector<N>, Angular<N>),
    inv_h: f32,
}

impl<N: Lane> EndRow<N> {
    const NONE: Self = Self {
        turn: N::ZERO,
        along: N::ZERO,
        apart: N::ZERO,
        arm: Vector::ZERO,
        from: Vector::ZERO,
        basis: Rot::IDENTITY,
        ground: Rot::IDENTITY,
        before: N::ZERO,
        turned: N::ZERO,
        turns: N::ZERO,
    };

    /// The change of the end's part of the sum since the start of the step, its gradient with respect to
    /// the anchor's velocity and to the angular velocity, and the arm.
    #[inline(always)]
    fn evaluate(&mut self, (shift, turn): (Vector<N>, Rot<N>)) -> (N, Vector<N>, Angular<N>, Vector<N>) {
        let arm = turn.rotate(self.arm);
        let moved = shift + arm - self.arm;
        let between = self.from + moved;
        let axis = self.ground.rotate(Vector::splat(Vector::X));
        let distance = between.length();
        let is_apart = N::ZERO.lt(distance);
        let direction = between * (N::ONE / N::select(is_apart, distance, N::ONE));
        let direction = Vector::select(is_apart, direction, Vector::splat(Vector::X));
        let (angle, about) = angles([self.ground, turn.mul(self.basis)])[TURNING];
        self.count(angle - self.before);
        let change =
            self.along * axis.dot(moved) + self.apart * (distance - self.before) + self.turn * self.turned;
        (change, axis * self.along + direction * self.apart, about * self.turn, arm)
    }

    /// Updates the rotation since the start of the step from an angle without whole turns.
    #[inline(always)]
    fn count(&mut self, angle: N) {
        let full = N::splat(core::f32::consts::TAU);
        let (half, off) = (N::splat(core::f32::consts::PI), angle + self.turns - self.turned);
        let turns = N::select(half.lt(off), self.turns - full, self.turns);
        self.turns = N::select(off.lt(-half), turns + full, turns);
        self.turned = angle + self.turns;
    }
}

impl<N: Lane> Default for CouplingRow<N> {
    fn default() -> Self {
        Self {
            ids: [N::Ids::splat(0); 2],
            ends: [EndRow::NONE; 2],
            masses: Masses::NONE,
            start: N::ZERO,
            limits: [N::ZERO; 2],
            softening: Softening::NONE,
            impulses: [N::ZERO; 2],
            on_b: (Vector::ZERO, Angular::ZERO),
            inv_h: 0.0,
        }
    }
}

impl<N: Lane> CouplingRow<N> {
    /// Copies a coupling into a lane.
    fn set(&mut self, lane: usize, record: &CouplingRecord, from: &Filling) {
        let (table, def, params) = (from.input.bodies, &record.def, from.params);
        let values = record.values_now(table);
        let zero = record.zero();
        for side in 0..2 {
            let (body, end, row) = (def.bodies[side], &def.ends[side], &mut self.ends[side]);
            let weight = if side == 0 { 1.0 } else { def.ratio };
            let part = match end.coordinate {
                EndCoordinate::Turn => &mut row.turn,
                EndCoordinate::Shift => &mut row.along,
                EndCoordinate::Distance => &mut row.apart,
            };
            part.set(lane, weight);
            let (arm, basis) = end.place(table, body);
            row.arm.set(lane, arm);
            row.from.set(lane, (end.offset(table, body) + arm.to_world()).to_local());
            row.basis.set(lane, basis);
            row.ground.set(lane, end.ground.rotation.normalized());
            let before = match end.coordinate {
                EndCoordinate::Distance => values[side] as f32,
                _ => angles([end.ground.rotation.normalized(), basis])[TURNING].0,
            };
            row.before.set(lane, before);
            let number = from.input.row_of(body);
            self.ids[side].set(lane, number);
            // Axis factors, until the mass is known.
            self.masses.linear[side]
                .set(lane, from.axes.get(number as usize).copied().unwrap_or(Vector::ONE));
        }
        let [a, b] = values;
        self.start.set(lane, (a + f64::from(def.ratio) * b - zero) as f32);
        for (i, limit) in def.limits.into_iter().enumerate() {
            self.limits[i].set(lane, (f64::from(limit) - zero) as f32);
            self.impulses[i].set(lane, record.impulses[i] * params.warm_start);
        }
        self.softening.set(lane, def.give, &Stiffness::new(Hold::Row, params.h));
        self.inv_h = params.inv_h;
    }

    /// Computes derived values, for all lanes at once.
    #[inline(always)]
    fn finish(&mut self, masses: &[MassRow]) {
        for side in 0..2 {
            let (inv_mass, inertia) = MassRow::gather::<N>(masses, &self.ids[side]);
            self.masses.linear[side] = InvMass::new(inv_mass, self.masses.linear[side]);
            self.masses.angular[side] = inertia;
        }
    }

    /// Runs a pass.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the row's writable bodies, or writes the
    /// others.
    #[inline(always)]
    unsafe fn run(&mut self, bodies: &RowView<BodyRow>, params: &SubstepParams, pass: SolverPass) {
        // SAFETY: by the contract.
        let (deltas, mut pair) = unsafe {
            let [a, b] = &self.ids;
            let deltas = [BodyRow::gather_delta::<N>(bodies, a), BodyRow::gather_delta::<N>(bodies, b)];
            (deltas, Pair::<N>::load(bodies, &self.ids))
        };
        let (mut value, mut k) = (self.start, N::ZERO);
        let mut responses = [(Vector::ZERO, Angular::ZERO); 2];
        let mut along = responses;
        for side in 0..2 {
            let (change, normal, turn, arm) = self.ends[side].evaluate(deltas[side]);
            let moment = arm.cross(normal) + turn;
            along[side] = (normal, moment);
            let (v, w) = (self.masses.linear[side].apply(normal), self.masses.angular[side].apply(moment));
            responses[side] = (v, w);
            value += change;
            k += v.dot(normal) + w.dot(moment);
            self.on_b = (normal, turn);
        }
        if pass == SolverPass::WarmStart {
            push(&mut pair, &responses, self.impulses[0] - self.impulses[1]);
        } else {
            let both = self.limits[0].eq(self.limits[1]);
            for side in 0..2 {
                let sign = if side == 0 { N::ONE } else { -N::ONE };
                let mut rate = N::ZERO;
                for end in 0..2 {
                    rate += along[end].0.dot(pair.v[end]) + along[end].1.dot(pair.w[end]);
                }
                let gap = (value - self.limits[side]) * sign;
                let before = self.impulses[side];
                let at = (gap, rate * sign, k);
                let after = self.softening.limit(side, both, at, before, params, pass == SolverPass::Solve);
                self.impulses[side] = after;
                push(&mut pair, &responses, (after - before) * sign);
            }
        }
        let impulse = self.impulses[0] - self.impulses[1];
        self.on_b = (self.on_b.0 * impulse, self.on_b.1 * impulse);
        // SAFETY: by the contract.
        unsafe { pair.store(bodies, &self.ids) };
    }

    /// Stores the impulses and the reaction of a lane in its coupling.
    fn store(&self, lane: usize, reaction: &mut JointReaction, coupling: &mut CouplingRecord) {
        let inv_h = self.inv_h;
        *reaction = JointReaction {
            force: self.on_b.0.get(lane) * inv_h,
            torque: self.on_b.1.get(lane) * inv_h,
            ..JointReaction::default()
        };
        coupling.impulses = self.impulses.map(|impulse| impulse.get(lane));
        coupling.force = (coupling.impulses[0] - coupling.impulses[1]) * inv_h;
        for side in 0..2 {
            let row = &self.ends[side];
            if coupling.def.ends[side].coordinate == EndCoordinate::Turn {
                coupling.values[side] += f64::from(row.turned.get(lane));
            }
        }
    }
}

/// Applies an impulse to both bodies. `responses` are their velocity changes by a unit impulse.
#[inline(always)]
fn push<N: Lane>(pair: &mut Pair<N>, responses: &[(Vector<N>, Angular<N>); 2], impulse: N) {
    for side in 0..2 {
        pair.v[side] += responses[side].0 * impulse;
        pair.w[side] += responses[side].1 * impulse;
    }
}

/// A view of coupling rows. Several threads may change its blocks.
pub(super) struct CouplingView<'a, N: Entry> {
    pub(super) proof: N::Proof,
    pub(super) rows: Parts<'a, CouplingRow<N>>,
    pub(super) records: &'a Records<'a>,
}

impl<N: Entry> Batch for CouplingView<'_, N> {
    unsafe fn fill(&self, rows: Range<usize>, items: &[Item], from: &Filling) -> SolverPasses {
        // SAFETY: by the contract.
        let rows = unsafe { self.rows.take(rows) };
        for (row, lanes) in rows.iter_mut().zip(items.chunks(N::WIDTH)) {
            *row = CouplingRow::default();
            for (lane, item) in lanes.iter().enumerate() {
                // SAFETY: a coupling is in one row, so by the contract no other thread uses its record.
                if let Some(coupling) = unsafe { self.records.coupling(item.id) } {
                    row.set(lane, coupling, from);
                }
            }
        }
        // SAFETY: the job has no further condition.
        unsafe { N::enter(self.proof, FinishJob { rows, masses: from.masses }) };
        SolverPasses::BASIC
    }

    unsafe fn run(&self, rows: Range<usize>, _: SolverPasses, sweep: &Sweep) {
        // SAFETY: by the contract.
        unsafe { N::enter(self.proof, RunJob { rows: self.rows.take(rows), sweep }) };
    }

    unsafe fn store(&self, rows: Range<usize>, items: &[Item], _: &ManifoldsView) {
        // SAFETY: by the contract.
        let rows = unsafe { self.rows.take(rows) };
        for (row, lanes) in rows.iter().zip(items.chunks(N::WIDTH)) {
            for (lane, item) in lanes.iter().enumerate() {
                // SAFETY: a coupling is in one row, so by the contract no other thread uses its record or
                // state.
                let (joint, coupling) =
                    unsafe { (self.records.joint(item.id), self.records.coupling(item.id)) };
                if let Some(coupling) = coupling {
                    row.store(lane, &mut joint.state.reaction, coupling);
                }
            }
        }
    }
}

struct FinishJob<'a, N: Lane> {
    rows: &'a mut [CouplingRow<N>],
    masses: &'a [MassRow],
}

impl<N: Lane> Job for FinishJob<'_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        for row in self.rows.iter_mut() {
            row.finish(self.masses);
        }
    }
}

struct RunJob<'a, N: Lane> {
    rows: &'a mut [CouplingRow<N>],
    sweep: &'a Sweep<'a>,
}

impl<N: Lane> Job for RunJob<'_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        let Sweep { bodies, params, pass, .. } = self.sweep;
        for row in self.rows.iter_mut() {
            // SAFETY: by the contract.
            unsafe { row.run(bodies, params, *pass) };
        }
    }
}
