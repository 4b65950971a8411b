//! The parts of a pass over a group of trees: the wanted velocities of joints, and the direct solution.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::super::BodyRow;
use super::super::batch::{SolverPass, Sweep};
use super::super::pair::Pair;
use super::dim::{BLOCK, DOF, inverse_of, least_element, numbers, of_numbers, with_inertia};
use super::elimination::{self, screw};
use super::forest::GROUND;
use super::place::{Gradient, Place};
use super::tree_pass::Tree;
use super::tree_scratch::{Known, Scratch};
use super::tree_single::{is, number};
use crate::math::{Angular, DIM, Entry, InvInertia, Lane, Rot, Vector};
use crate::tuning::manifold::SAME;
use crate::tuning::solver::NO_MASS;

/// Lanes in which two velocities differ.
#[inline(always)]
fn differs<N: Lane>(a: &[N; DOF], b: &[N; DOF]) -> N::Mask {
    let mut any = a[0].lt(a[0]);
    for i in 0..DOF {
        any = N::or(any, N::or(a[i].lt(b[i]), b[i].lt(a[i])));
    }
    any
}

impl<N: Entry> Tree<'_, N> {
    /// The current velocities of a joint's bodies.
    #[inline(always)]
    pub(super) fn pair(&self, k: usize) -> Pair<N> {
        let joint = &self.joints[k];
        let mut pair = Pair::default();
        for end in 0..2 {
            let (place, side) = (self.links[k].places[end], joint.side(end));
            let is_outside = place == GROUND;
            let velocity = if is_outside { joint.outside } else { self.scratch.velocities[place as usize] };
            (pair.v[side], pair.w[side]) = of_numbers(velocity);
        }
        pair
    }

    /// Computes the current positions of joints.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the trees.
    #[inline(always)]
    pub(super) unsafe fn place(&mut self, sweep: &Sweep) {
        let Scratch { known, coordinates, open, .. } = &mut *self.scratch;
        let open = is(*open);
        for (joint, link) in self.joints.iter_mut().zip(&mut *self.links) {
            // SAFETY: by the contract.
            let place = unsafe { joint.row.start.now(&sweep.bodies, &joint.row.ids) };
            let range = joint.singles();
            let has_angles = joint.locks().last().is_some_and(|last| last >= DIM);
            let angles = match has_angles || !range.is_empty() {
                true => place.angles(),
                false => Place::NO_ANGLES,
            };
            match has_angles {
                false => joint.lock::<DIM>(&place, &angles, link),
                true => joint.lock::<BLOCK>(&place, &angles, link),
            }
            for (single, at) in self.singles[range.clone()].iter_mut().zip(&mut coordinates[range]) {
                let (turns, near) = (single.turns, single.near);
                (at.gradient, at.value) = single.gradient(&place, &angles);
                single.turns = N::select(open, single.turns, turns);
                single.near = N::select(open, single.near, near);
                // A blow may have deactivated a limit whose impulse was restored afterwards.
                let (held, is_free) = (single.held(), (at.held[0] + at.held[1]).eq(N::ZERO));
                for side in 0..2 {
                    at.held[side] = N::select(is_free, held[side], at.held[side]);
                }
            }
        }
        *known = Known::Places;
    }

    /// Loads velocities. Closes lanes with the same velocities as in the last pass, if it solved them with
    /// the same factors. Returns whether any lane is open.
    ///
    /// # Safety
    /// As [`place`](Self::place).
    #[inline(always)]
    pub(super) unsafe fn load(&mut self, sweep: &Sweep) -> bool {
        let Scratch { known, velocities, settled, open, .. } = &mut *self.scratch;
        let is_repeated = *known == Known::Factors(sweep.pass) && velocities.len() == self.bodies.len();
        let mut changed = if is_repeated { N::ONE - *settled } else { N::ONE };
        velocities.resize(self.bodies.len(), [N::ZERO; DOF]);
        for (body, velocity) in self.bodies.iter().zip(velocities) {
            // SAFETY: by the contract.
            let now = numbers(unsafe { BodyRow::gather_velocity::<N>(&sweep.bodies, &body.ids) });
            changed = N::select(differs::<N>(velocity, &now), N::ONE, changed);
            *velocity = now;
        }
        for (joint, link) in self.joints.iter_mut().zip(&*self.links) {
            for (end, place) in link.places.into_iter().enumerate() {
                if place == GROUND {
                    let ids = &joint.row.ids[joint.side(end)];
                    // SAFETY: by the contract.
                    let now = numbers(unsafe { BodyRow::gather_velocity::<N>(&sweep.bodies, ids) });
                    changed = N::select(differs::<N>(&joint.outside, &now), N::ONE, changed);
                    joint.outside = now;
                }
            }
        }
        *open = N::select(is(changed), *open, N::ZERO);
        N::any(is(*open))
    }

    /// Computes the inertia of bodies at their current rotations, with the inertia that joints require.
    ///
    /// # Safety
    /// As [`place`](Self::place).
    #[inline(always)]
    pub(super) unsafe fn turn_bodies(&mut self, sweep: &Sweep) {
        let h = N::splat(sweep.params.h);
        for body in self.bodies.iter_mut() {
            body.least = N::ZERO;
        }
        for (joint, link) in self.joints.iter().zip(&*self.links) {
            for (end, place) in link.places.into_iter().enumerate() {
                if let Some(body) = self.bodies.get_mut(place as usize) {
                    body.least += h * joint.load * joint.arms[joint.side(end)];
                }
            }
        }
        // Closed lanes keep the masses that the warm start uses.
        let open = is(self.scratch.open);
        for (body, node) in self.bodies.iter_mut().zip(&mut *self.nodes) {
            // SAFETY: by the contract.
            let (_, turn) = unsafe { BodyRow::gather_delta::<N>(&sweep.bodies, &body.ids) };
            let turn = Rot::select(is(body.turns), turn, Rot::IDENTITY);
            body.turned = body.angular.turned(turn).scaled(least_element(body.share));
            body.lacking = N::select(open, body.lacks(), body.lacking);
            body.now = with_inertia(body.turned, body.lacking);
            node.inverse = inverse_of(body.linear.scale(body.share), body.now);
        }
        for (joint, link) in self.joints.iter_mut().zip(&*self.links) {
            for (end, place) in link.places.into_iter().enumerate() {
                let side = joint.side(end);
                let (linear, angular) = match self.bodies.get(place as usize) {
                    Some(body) => (body.linear.scale(body.share), body.now),
                    None => (Vector::ZERO, InvInertia::ZERO),
                };
                joint.row.masses.set_where(open, side, linear, angular);
            }
        }
    }

    /// Factors the trees with locked coordinates alone, as in the relax pass.
    ///
    /// # Safety
    /// None: the function is unsafe because all parts are.
    #[inline(always)]
    pub(super) unsafe fn factor_locked(&mut self, _: &Sweep) {
        for (joint, link) in self.joints.iter_mut().zip(&mut *self.links) {
            joint.soften(link, SolverPass::Relax);
        }
        elimination::factor(self.links, self.nodes);
    }

    /// Computes the mass that a spring or motor with a law per mass moves, with all locked coordinates.
    #[inline(always)]
    pub(super) fn weigh(&mut self, k: usize, index: usize) {
        let gradient = self.scratch.coordinates[index].gradient;
        let alone = self.joints[k].row.masses.response(&gradient).along(&gradient);
        let left = self.unit_response(k, &gradient).along(&gradient);
        // No impulse moves a coordinate that is already locked.
        let moves = (alone * N::splat(NO_MASS)).lt(left);
        self.scratch.coordinates[index].left = N::select(moves, left, N::ZERO);
    }

    /// Adds a row for each coordinate with an active limit, spring or motor, and factors the trees.
    ///
    /// # Safety
    /// None: the function is unsafe because all parts are.
    #[inline(always)]
    pub(super) unsafe fn factor_all(&mut self, sweep: &Sweep) {
        let biased = sweep.pass == SolverPass::Solve;
        for (joint, link) in self.joints.iter_mut().zip(&mut *self.links) {
            joint.soften(link, sweep.pass);
            let range = joint.singles();
            for (single, at) in self.singles[range.clone()].iter().zip(&mut self.scratch.coordinates[range]) {
                at.alone = joint.row.masses.response(&at.gradient).along(&at.gradient);
                let softness = single.softness(at, sweep.params, biased);
                let acts = is(softness);
                at.acts = number(acts);
                at.row = None;
                if N::any(acts) {
                    let Gradient { normal, moments: [a, b] } = at.gradient;
                    let normal = Vector::select(acts, normal, Vector::ZERO);
                    let moments =
                        [Angular::select(acts, a, Angular::ZERO), Angular::select(acts, b, Angular::ZERO)];
                    at.row = Some(joint.add_row(&Gradient { normal, moments }, softness, link));
                }
            }
        }
        elimination::factor(self.links, self.nodes);
    }

    /// Solves the trees for the wanted velocities of the joints.
    ///
    /// # Safety
    /// None: the function is unsafe because all parts are.
    #[inline(always)]
    pub(super) unsafe fn round(&mut self, sweep: &Sweep) {
        self.ask(sweep);
        elimination::solve(self.links, self.nodes);
        self.apply(self.scratch.open, sweep);
    }

    /// Writes the wanted velocities of the joints; zero in closed lanes.
    #[inline(always)]
    fn ask(&mut self, sweep: &Sweep) {
        let biased = sweep.pass == SolverPass::Solve;
        let open = is(self.scratch.open);
        for k in 0..self.joints.len() {
            let pair = self.pair(k);
            let (joint, link) = (&self.joints[k], &mut self.links[k]);
            joint.ask(&pair, link, open, sweep);
            let range = joint.singles();
            for (single, at) in self.singles[range.clone()].iter().zip(&self.scratch.coordinates[range]) {
                let Some(row) = at.row else { continue };
                let wanted = single.wanted(at, at.gradient.rate(&pair), sweep.params, biased);
                link.rows[row].wanted = N::select(open, wanted, N::ZERO).double();
            }
        }
    }

    /// Adds the solution to velocities and impulses in some lanes.
    #[inline(always)]
    pub(super) fn apply(&mut self, lanes: N, sweep: &Sweep) {
        let lanes = is(lanes);
        for (velocity, node) in self.scratch.velocities.iter_mut().zip(&*self.nodes) {
            let change = node.change();
            for i in 0..DOF {
                velocity[i] = N::select(lanes, velocity[i] + N::of_double(change[i]), velocity[i]);
            }
        }
        for k in 0..self.joints.len() {
            let (joint, link) = (&mut self.joints[k], &self.links[k]);
            for (i, row) in joint.locks().zip(&link.rows) {
                let locked = &mut joint.row.block[i];
                let impulse = locked.impulse + N::of_double(row.impulse);
                locked.impulse = N::select(lanes, impulse, locked.impulse);
            }
            let range = joint.singles();
            let mut acts = false;
            for at in &self.scratch.coordinates[range.clone()] {
                acts |= at.row.is_some();
            }
            if !acts {
                continue;
            }
            let pair = self.pair(k);
            for (single, at) in self.singles[range.clone()].iter_mut().zip(&self.scratch.coordinates[range]) {
                let Some(row) = at.row else { continue };
                let solved = (N::of_double(self.links[k].rows[row].impulse), at.gradient.rate(&pair));
                let lanes = N::and(lanes, is(at.acts));
                single.share_out(at, lanes, solved, sweep.params, sweep.pass == SolverPass::Solve);
            }
        }
    }

    /// Determines the active limits and the motors at their maximum. Lanes in which any of them changed
    /// stay open. Returns whether there are any.
    ///
    /// # Safety
    /// None: the function is unsafe because all parts are.
    #[inline(always)]
    pub(super) unsafe fn pivot(&mut self, sweep: &Sweep) -> bool {
        let Scratch { settled, open, adds, .. } = &mut *self.scratch;
        // Lanes that are still open in a round without activation of limits are not settled.
        *settled = if *adds { N::ONE } else { settled.min(N::ONE - *open) };
        let (open, mut any_changed) = (is(*open), N::ZERO);
        let mut changes = core::mem::take(&mut self.scratch.changes);
        changes.clear();
        let adds = self.scratch.adds;
        for k in 0..self.joints.len() {
            let range = self.joints[k].singles();
            if range.is_empty() || self.scratch.is_last {
                continue;
            }
            let pair = self.pair(k);
            for index in range {
                let (single, at) = (&mut self.singles[index], &mut self.scratch.coordinates[index]);
                let is_turn = at.gradient.normal.length_squared().eq(N::ZERO);
                let of_length = N::select(is_turn, N::splat(SAME), N::splat(sweep.params.max_sag));
                let tolerance = N::splat(SAME) * of_length / N::splat(sweep.params.dt);
                let solved = (at.gradient.rate(&pair), tolerance, adds);
                let biased = sweep.pass == SolverPass::Solve;
                let (changed, change) = single.pivot(at, open, solved, sweep.params, biased);
                any_changed = N::select(changed, N::ONE, any_changed);
                if N::any(N::or(change.lt(N::ZERO), is(change))) {
                    changes.push((k, index, change));
                }
            }
        }
        for (k, index, change) in &changes {
            let gradient = self.scratch.coordinates[*index].gradient;
            self.push(*k, &gradient, *change);
        }
        self.scratch.changes = changes;
        self.scratch.was_open = self.scratch.open;
        self.scratch.open = any_changed;
        let any = N::any(is(any_changed));
        if any {
            self.scratch.known = Known::Places;
        }
        any
    }

    /// Applies an impulse along a gradient of a joint to its two bodies only.
    #[inline(always)]
    fn push(&mut self, k: usize, gradient: &Gradient<N>, impulse: N) {
        let pushes = N::or(is(impulse), impulse.lt(N::ZERO));
        for (end, place) in self.links[k].places.into_iter().enumerate() {
            let Some(node) = self.nodes.get(place as usize) else { continue };
            let side = self.joints[k].side(end);
            let impulse = if side == 0 { -impulse } else { impulse };
            let changes = node.moved(&screw(gradient.normal * impulse, gradient.moments[side] * impulse));
            let velocity = &mut self.scratch.velocities[place as usize];
            for i in 0..DOF {
                velocity[i] = N::select(pushes, velocity[i] + N::of_double(changes[i]), velocity[i]);
            }
        }
    }

    /// Stores velocities, and sums up the impulses of single coordinates.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    #[inline(always)]
    pub(super) unsafe fn finish(&mut self, sweep: &Sweep) {
        let Scratch { velocities, coordinates, .. } = &*self.scratch;
        for (body, velocity) in self.bodies.iter().zip(velocities) {
            let (v, w) = of_numbers(*velocity);
            // SAFETY: by the contract.
            unsafe { BodyRow::scatter_velocity::<N>(&sweep.bodies, &body.ids, v, w) };
        }
        for joint in self.joints.iter_mut() {
            let range = joint.singles();
            joint.besides = screw(Vector::ZERO, joint.row.turning);
            for (single, coordinate) in self.singles[range.clone()].iter().zip(&coordinates[range]) {
                let Gradient { normal, moments } = coordinate.gradient;
                let of_single = screw(normal, moments[1]);
                elimination::add::<N>(&mut joint.besides, &of_single, single.impulse().double());
            }
        }
    }

    /// Stores the loads on joints.
    ///
    /// # Safety
    /// None: the function is unsafe because all parts are.
    #[inline(always)]
    pub(super) unsafe fn bear(&mut self, sweep: &Sweep) {
        for (joint, link) in self.joints.iter_mut().zip(&*self.links) {
            joint.bear(link, sweep);
        }
    }

    /// As [`warm_start`](Self::warm_start).
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    #[inline(always)]
    pub(super) unsafe fn warm(&mut self, sweep: &Sweep) {
        for joint in self.joints.iter_mut() {
            for locked in &mut joint.row.block {
                locked.impulse = N::ZERO;
            }
            let range = joint.singles();
            for single in &mut self.singles[range.clone()] {
                let is_spring = is(single.softening.is_spring);
                for impulse in &mut single.impulses {
                    *impulse = N::select(is_spring, *impulse, N::ZERO);
                }
            }
            // SAFETY: by the contract.
            unsafe {
                if joint.is_warm {
                    let more = (&mut self.singles[range], joint.orientation.as_mut());
                    joint.row.run::<0>(more, &sweep.bodies, sweep.params, sweep.pass);
                } else if N::any(is(joint.row.damping[0] + joint.row.damping[1])) {
                    let mut pair = Pair::load(&sweep.bodies, &joint.row.ids);
                    joint.row.damp(&mut pair);
                    pair.store(&sweep.bodies, &joint.row.ids);
                }
            }
        }
    }
}
