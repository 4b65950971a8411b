//! Limits and motors of a tree, each solved by the response of the whole tree to a unit impulse along its coordinate.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::super::batch::{Pass, Sweep};
use super::super::pair::Pair;
use super::dim::{BLOCK, motion, of_numbers, screw};
use super::elimination::{self, Screw};
use super::forest::GROUND;
use super::place::{Gradient, Response};
use super::tree_pass::Tree;
use super::tree_scratch::{Coordinate, MOST_KEPT, NOT_YET, Scratch};
use crate::math::{Angular, Vector};
use crate::tuning::manifold::SAME;
use crate::tuning::solver::JOINT_ROUNDS;

impl Tree<'_> {
    /// Solves limits and motors, which act on each other.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    pub(super) unsafe fn solve_limits_and_motors(&mut self, sweep: &Sweep) {
        let mut first = 0.0;
        for round in 0..JOINT_ROUNDS {
            let (mut most, mut count) = (0.0f32, 0);
            for k in 0..self.joints.len() {
                if round == 0 {
                    // SAFETY: by the contract.
                    unsafe { self.solve_orientation(k, sweep) };
                }
                let (change, acting) = self.solve_singles(k, sweep, round > 0);
                (most, count) = (most.max(change), count + acting);
            }
            first = if round == 0 { most } else { first };
            if count < 2 || most <= SAME * first.max(1.0) {
                break;
            }
        }
    }

    /// Solves the orientation motor of a joint.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    unsafe fn solve_orientation(&mut self, k: usize, sweep: &Sweep) {
        let joint = &mut self.joints[k];
        joint.row.turning = Angular::ZERO;
        let Some(mut motor) = joint.orientation else { return };
        // SAFETY: by the contract.
        let place = unsafe { joint.row.start.now(&sweep.bodies, &joint.row.ids) };
        let turning = motor.look(&place);
        if sweep.pass == Pass::Solve {
            let alone = turning.gradients.map(|gradient| joint.row.masses.response(&gradient));
            let responses = turning.gradients.map(|gradient| self.unit_response(k, &gradient));
            let changes = motor.act(&turning, (&responses, &alone), &self.pair(k), sweep.params.h);
            self.joints[k].orientation = Some(motor);
            let mut sum = Angular::ZERO;
            for (gradient, change) in turning.gradients.iter().zip(changes) {
                sum += gradient.moments[1] * change;
            }
            self.unit_response(k, &place.gradient(Vector::ZERO, sum));
            self.apply();
        }
        for (gradient, impulse) in turning.gradients.iter().zip(motor.impulses) {
            self.joints[k].row.turning += gradient.moments[1] * impulse;
        }
    }

    /// The velocities of a joint's bodies now.
    fn pair(&self, k: usize) -> Pair<f32> {
        let joint = &self.joints[k];
        let mut pair = joint.pair;
        for (end, place) in self.links[k].places.into_iter().enumerate().filter(|(_, place)| *place != GROUND)
        {
            let side = joint.side(end);
            (pair.v[side], pair.w[side]) = of_numbers(self.scratch.velocities[place as usize]);
        }
        pair
    }

    /// Solves limits and motors of a joint, and changes the velocities of all bodies so that what is locked stays solved. Returns by
    /// how much that moves a coordinate in a step at most, as a multiple of the tolerance, and how many limits act. Once more,
    /// only those with limits.
    fn solve_singles(&mut self, k: usize, sweep: &Sweep, again: bool) -> (f32, u32) {
        let biased = sweep.pass == Pass::Solve;
        let (mut most, mut acting) = (0.0f32, 0);
        let range = self.joints[k].singles_from(self.first_single);
        if range.is_empty() {
            return (most, acting);
        }
        let mut pair = self.pair(k);
        for index in range {
            let single = &self.singles[index];
            if again && !single.has_limits() {
                continue;
            }
            let coordinate = &self.scratch.coordinates[index];
            if !single.may_act(coordinate.value, coordinate.gradient.rate(&pair), sweep.params.h) {
                continue;
            }
            if coordinate.number == NOT_YET {
                self.keep_response(k, index);
            }
            let Scratch { velocities, unit_velocities, coordinates, .. } = &mut *self.scratch;
            let (single, coordinate) = (&mut self.singles[index], &mut coordinates[index]);
            let Coordinate { gradient, value, number, response, alone, .. } = &*coordinate;
            let change = single.act((gradient, *value), (response, alone), &mut pair, sweep.params, biased);
            let tolerance = if gradient.normal == Vector::ZERO { SAME } else { sweep.params.max_sag };
            most = most.max((change * response.along(gradient)).abs() * sweep.params.dt / tolerance);
            acting += u32::from(single.impulses != [0.0; 2]);
            let unit_velocities = unit_velocities[*number * velocities.len()..].as_flattened();
            for (velocity, unit) in velocities.as_flattened_mut().iter_mut().zip(unit_velocities) {
                *velocity += unit * change;
            }
            coordinate.change += change;
        }
        (most, acting)
    }

    /// Keeps what a unit impulse along a single coordinate of a joint changes in the whole tree.
    fn keep_response(&mut self, k: usize, index: usize) {
        if self.scratch.unit_velocities.len() >= MOST_KEPT {
            self.add_lock_impulses();
            self.scratch.forget_responses();
        }
        let gradient = self.scratch.coordinates[index].gradient;
        let alone = self.joints[k].row.masses.response(&gradient);
        let response = self.unit_response(k, &gradient);
        let Scratch { unit_velocities, unit_impulses, coordinates, .. } = &mut *self.scratch;
        let number = unit_velocities.len() / self.nodes.len();
        coordinates[index] = Coordinate { number, response, alone, ..coordinates[index] };
        unit_velocities.extend(self.nodes.iter().map(|node| node.change().map(|change| change as f32)));
        unit_impulses.extend(self.links.iter().map(|link| link.impulses.map(|impulse| impulse as f32)));
    }

    /// Solves the tree for a unit impulse along a coordinate of a joint, and adds the impulse to those on its bodies. The
    /// response of the joint's bodies.
    fn unit_response(&mut self, k: usize, gradient: &Gradient<f32>) -> Response<f32> {
        let Self { joints, links, nodes, .. } = self;
        let ends: [(u32, Screw); 2] = core::array::from_fn(|end| {
            let sign = if joints[k].side(end) == 0 { -1.0 } else { 1.0 };
            let moment = gradient.moments[joints[k].side(end)];
            (links[k].places[end], screw(gradient.normal * sign, moment * sign))
        });
        for link in links.iter_mut() {
            link.wanted = [0.0; BLOCK];
            for (place, push) in ends.iter().filter(|(place, _)| *place != GROUND) {
                if let Some(end) = link.places.iter().position(|other| other == place) {
                    link.want_against(end, &nodes[*place as usize].moved(push));
                }
            }
        }
        elimination::solve(links, nodes);
        let mut response = Response { v: [Vector::ZERO; 2], w: [Angular::ZERO; 2] };
        for (end, (place, push)) in ends.into_iter().enumerate().filter(|(_, (place, _))| *place != GROUND) {
            let node = &mut nodes[place as usize];
            elimination::add(&mut node.impulse, &push, 1.0);
            let (v, w) = motion(&node.change());
            let side = joints[k].side(end);
            let sign = if side == 0 { -1.0 } else { 1.0 };
            (response.v[side], response.w[side]) = (v * sign, w * sign);
        }
        response
    }

    /// Adds the impulses with which what is locked has answered limits and motors.
    pub(super) fn add_lock_impulses(&mut self) {
        let Scratch { unit_impulses, coordinates, .. } = &mut *self.scratch;
        for coordinate in coordinates.iter_mut().filter(|coordinate| coordinate.change != 0.0) {
            let unit_impulses = &unit_impulses[coordinate.number * self.joints.len()..];
            for (joint, answer) in self.joints.iter_mut().zip(unit_impulses) {
                for (locked, answer) in joint.locked().zip(answer) {
                    locked.impulse += answer * coordinate.change;
                }
            }
            coordinate.change = 0.0;
        }
    }
}
