//! Orientation motors of trees. Each is solved with the responses of the whole tree to impulses along its
//! axes.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::super::batch::{SolverPass, Sweep};
use super::dim::{DOF, TURNS};
use super::elimination::{self, Screw, motion, screw};
use super::forest::GROUND;
use super::place::{Gradient, Response};
use super::tree_pass::{Tree, TreeEntry};
use super::tree_single::{is, number};
use crate::math::{Angular, Entry, Job, Num, Vector};

/// Finds the lanes whose motors are due, because their pivoting is complete. Returns whether there are any.
struct Begin<'t, 'a, N: Entry>(&'t mut Tree<'a, N>);

impl<N: Entry> Job for Begin<'_, '_, N> {
    type Output = bool;

    #[inline(always)]
    unsafe fn run(self) -> bool {
        let scratch = &mut *self.0.scratch;
        let is_done = (scratch.open + scratch.driven).eq(N::ZERO);
        let due = N::and(is_done, is(scratch.was_open));
        scratch.due = number(due);
        scratch.driven = N::select(due, N::ONE, scratch.driven);
        N::any(due)
    }
}

/// Solves the orientation motor of a joint in the due lanes.
struct Solve<'t, 'a, N: Entry>(&'t mut Tree<'a, N>, usize, &'t Sweep<'t>);

impl<N: Entry> Job for Solve<'_, '_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        // SAFETY: by the contract.
        unsafe { self.0.solve_orientation(self.1, self.2) };
    }
}

/// Adds lanes that were open before to the open lanes. Returns whether any lane is open.
struct End<'t, 'a, N: Entry>(&'t mut Tree<'a, N>, N);

impl<N: Entry> Job for End<'_, '_, N> {
    type Output = bool;

    #[inline(always)]
    unsafe fn run(self) -> bool {
        let open = N::or(is(self.0.scratch.open), is(self.1));
        self.0.scratch.open = number(open);
        N::any(open)
    }
}

impl<N: Entry> Tree<'_, N> {
    /// Solves the motors, once, in lanes whose pivoting is complete, and pivots again. Returns whether any
    /// lane is open.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    pub(super) unsafe fn solve_motors(&mut self, sweep: &Sweep) -> bool {
        let (entry, open): (TreeEntry<N>, N) = (self.entry, self.scratch.open);
        // SAFETY: by the contract.
        unsafe {
            if entry.run(Begin(self)) {
                for k in 0..self.joints.len() {
                    if self.joints[k].orientation.is_some() {
                        entry.run(Solve(self, k, sweep));
                    }
                }
                self.scratch.open = self.scratch.due;
                self.pivot_again(sweep);
            }
            entry.run(End(self, open))
        }
    }

    /// Solves the orientation motor of a joint.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    #[inline(always)]
    unsafe fn solve_orientation(&mut self, k: usize, sweep: &Sweep) {
        let due = is(self.scratch.due);
        let joint = &mut self.joints[k];
        let Some(mut motor) = joint.orientation else { return };
        // SAFETY: by the contract.
        let place = unsafe { joint.row.start.now(&sweep.bodies, &joint.row.ids) };
        let turning = motor.evaluate(&place);
        if sweep.pass == SolverPass::Solve {
            let before = motor.impulses;
            let mut alone = [Response::NONE; TURNS];
            for (alone, gradient) in alone.iter_mut().zip(&turning.gradients) {
                *alone = joint.row.masses.response(gradient);
            }
            let mut responses = [Response::NONE; TURNS];
            for (response, gradient) in responses.iter_mut().zip(&turning.gradients) {
                *response = self.unit_response(k, gradient);
            }
            let changes = motor.act(&turning, (&responses, &alone), &self.pair(k), sweep.params.h);
            let mut sum = Angular::ZERO;
            for i in 0..changes.len() {
                motor.impulses[i] = N::select(due, motor.impulses[i], before[i]);
                sum += turning.gradients[i].moments[1] * changes[i];
            }
            self.joints[k].orientation = Some(motor);
            self.unit_response(k, &place.gradient(Vector::ZERO, sum));
            self.apply(self.scratch.due, sweep);
        }
        let mut sum = Angular::ZERO;
        for (gradient, impulse) in turning.gradients.iter().zip(motor.impulses) {
            sum += gradient.moments[1] * impulse;
        }
        let row = &mut self.joints[k].row;
        row.turning = Angular::select(due, sum, row.turning);
    }

    /// Solves the trees for a unit impulse along a coordinate of a joint, and adds this impulse to the
    /// impulses on its bodies. Returns the response of the joint's bodies.
    #[inline(always)]
    pub(super) fn unit_response(&mut self, k: usize, gradient: &Gradient<N>) -> Response<N> {
        let Self { joints, links, nodes, .. } = self;
        let (joint, places) = (&joints[k], links[k].places);
        let mut pushes: [Screw<N>; 2] = [[N::Double::ZERO; DOF]; 2];
        for end in 0..2 {
            let side = joint.side(end);
            let moment = gradient.moments[side];
            pushes[end] = match side {
                0 => screw(-gradient.normal, -moment),
                _ => screw(gradient.normal, moment),
            };
        }
        for link in links.iter_mut() {
            for row in &mut link.rows {
                row.wanted = N::Double::ZERO;
            }
            for (place, push) in places.into_iter().zip(&pushes).filter(|(place, _)| *place != GROUND) {
                if let Some(end) = link.places.iter().position(|other| *other == place) {
                    link.want_against(end, &nodes[place as usize].moved(push));
                }
            }
        }
        elimination::solve(links, nodes);
        let mut response = Response::NONE;
        for end in 0..2 {
            let Some(node) = nodes.get_mut(places[end] as usize) else { continue };
            elimination::add::<N>(&mut node.impulse, &pushes[end], N::Double::ONE);
            let (v, w) = motion::<N>(&node.change());
            let side = joint.side(end);
            (response.v[side], response.w[side]) = if side == 0 { (-v, -w) } else { (v, w) };
        }
        response
    }
}
