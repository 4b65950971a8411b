//! One tree of joints in a pass: what joints ask for, the direct solution, limits and motors by the response of the whole tree.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::super::BodyRows;
use super::super::batch::{Pass, Sweep};
use super::super::pair::Pair;
use super::block::{Block, wrapped};
use super::dim::{BLOCK, DOF, inverse_of, motion, screw, with_least_inertia};
use super::elimination::{self, Link, Node, Screw};
use super::forest::GROUND;
use super::orientation::OrientationRow;
use super::place::{Gradient, Response};
use super::row::Row;
use super::single::Single;
use crate::math::{Angular, DIM, InvInertia, Vector};
use crate::tuning::manifold::SAME;
use crate::tuning::solver::{JOINT_ROUNDS, NO_MASS, SMALL_TURN};
use core::ops::Range;

/// Softness of a spring in the relax pass, where it takes no part, as a multiple of its inverse mass.
const LOOSE: f64 = 1.0e12;

/// A body of a tree, as it is without what contacts add to its mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct TreeBody {
    pub(super) row: u32,
    /// Inverse mass along each world axis, 1/kg. 0 along locked axes.
    pub(super) linear: Vector,
    /// At the start of the step.
    pub(super) angular: InvInertia,
    /// The share of the inverse mass along each axis that is left, as contacts see it.
    pub(super) share: Vector,
    /// Whether its inertia turns with it.
    pub(super) turns: bool,
    /// The same now, with what its joints ask for.
    pub(super) now: InvInertia,
    /// What they ask for: h Σ |impulse| |arm|, kg·m².
    pub(super) least: f32,
}

/// A joint of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct TreeJoint {
    pub(super) row: Row<f32>,
    /// The range of its single coordinates.
    pub(super) singles: [u32; 2],
    /// Number of coordinates up to the last that is locked.
    pub(super) locked_end: usize,
    /// Whether the first coordinate of its block is the distance of the anchors.
    pub(super) is_rod: bool,
    /// Its side at the parent.
    pub(super) parent_side: usize,
    /// Whether it has more than what is locked: single coordinates, or damping.
    pub(super) is_warm: bool,
    /// From B's centre of mass to its anchor.
    pub(super) arm: Vector,
    /// Lengths from the centres of mass to the anchors.
    pub(super) arms: [f32; 2],
    /// Length of the last impulse, N·s.
    pub(super) load: f32,
    /// The impulse on B and its moment of what is not locked.
    pub(super) besides: Screw,
    /// The orientation motor, if it has one.
    pub(super) orientation: Option<OrientationRow<f32>>,
}

pub(super) fn range([start, end]: [u32; 2]) -> Range<usize> {
    start as usize..end as usize
}

impl TreeBody {
    pub(super) fn new(row: u32, rows: &BodyRows) -> Self {
        let mass = &rows.masses[row as usize];
        let angular = mass.inv_inertia();
        Self {
            row,
            linear: rows.axes.get(row as usize).copied().unwrap_or(Vector::ONE) * mass.inv_mass(),
            angular,
            share: Vector::ONE,
            turns: !rows.turn_locked.contains(row),
            now: angular,
            least: 0.0,
        }
    }
}

impl TreeJoint {
    /// The side of its parent, 0, or of its child, 1.
    fn side(&self, end: usize) -> usize {
        if end == 0 { self.parent_side } else { 1 - self.parent_side }
    }

    /// The range of its single coordinates among those of its tree.
    pub(super) fn singles_from(&self, first: u32) -> Range<usize> {
        range(self.singles.map(|end| end - first))
    }
}

/// One tree.
pub(super) struct Tree<'a> {
    pub(super) joints: &'a mut [TreeJoint],
    pub(super) singles: &'a mut [Single<f32>],
    pub(super) first_single: u32,
    pub(super) links: &'a mut [Link],
    pub(super) nodes: &'a mut [Node],
    pub(super) bodies: &'a mut [TreeBody],
}

impl Tree<'_> {
    /// Solves all that is locked, then limits and motors, and notes what joints bear.
    ///
    /// # Safety
    /// Until it returns, no other thread reads or writes the dynamic bodies of the tree, or writes its other bodies.
    pub(super) unsafe fn solve(&mut self, sweep: &Sweep) {
        // SAFETY: by the contract.
        unsafe { self.project(sweep) };
        for (joint, link) in self.joints.iter_mut().zip(&*self.links) {
            joint.bear(link, sweep);
        }
    }

    /// Solves all that is locked, then limits and motors, which act on each other.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    pub(super) unsafe fn project(&mut self, sweep: &Sweep) {
        // SAFETY: by the contract.
        unsafe { self.weigh(sweep) };
        for (joint, link) in self.joints.iter_mut().zip(&mut *self.links) {
            for (k, place) in link.places.into_iter().enumerate() {
                let side = joint.side(k);
                let body = self.bodies.get(place as usize);
                joint.row.masses.linear[side] =
                    body.map_or(Vector::ZERO, |body| body.linear.scale(body.share));
                joint.row.masses.angular[side] = body.map_or(InvInertia::ZERO, |body| body.now);
            }
            // SAFETY: by the contract.
            unsafe {
                match joint.locked_end <= DIM {
                    true => joint.ask::<DIM>(link, sweep),
                    false => joint.ask::<BLOCK>(link, sweep),
                }
            }
        }
        elimination::factor(self.links, self.nodes);
        elimination::solve(self.links, self.nodes);
        // SAFETY: by the contract.
        unsafe {
            self.apply(1.0, sweep);
            let mut first = 0.0;
            for round in 0..JOINT_ROUNDS {
                let (mut most, mut count) = (0.0f32, 0);
                for k in 0..self.joints.len() {
                    if round == 0 {
                        self.joints[k].besides = [0.0; DOF];
                        self.turn(k, sweep);
                    }
                    let (change, acting) = self.solve_singles(k, sweep, round > 0);
                    (most, count) = (most.max(change), count + acting);
                }
                first = if round == 0 { most } else { first };
                if count < 2 || most <= SAME * first {
                    break;
                }
            }
        }
    }

    /// Applies what was solved, some times.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    unsafe fn apply(&mut self, times: f32, sweep: &Sweep) {
        for (node, body) in self.nodes.iter().zip(&*self.bodies) {
            let (v, w) = motion(&node.change());
            // SAFETY: by the contract.
            unsafe {
                sweep.bodies.put(body.row, |row| {
                    let before = row.velocity();
                    row.set_velocity(before.0 + v * times, before.1 + w * times);
                });
            }
        }
        for (joint, link) in self.joints.iter_mut().zip(&*self.links) {
            let locked = joint.row.block.iter_mut().filter(|locked| locked.is_locked > 0.0);
            for (locked, impulse) in locked.zip(&link.impulses) {
                locked.impulse += *impulse as f32 * times;
            }
        }
    }

    /// Solves the orientation motor of a joint, and changes the impulses of all joints so that they stay solved.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    unsafe fn turn(&mut self, k: usize, sweep: &Sweep) {
        let Some(mut motor) = self.joints[k].orientation else { return };
        let (row, Sweep { bodies, params, .. }) = (&self.joints[k].row, sweep);
        // SAFETY: by the contract.
        let (place, pair) = unsafe { (row.start.now(bodies, &row.ids), Pair::<f32>::load(bodies, &row.ids)) };
        let turning = motor.look(&place);
        if sweep.pass == Pass::Solve {
            let alone = turning.gradients.map(|gradient| row.masses.response(&gradient));
            let responses = turning.gradients.map(|gradient| self.beside(k, &gradient));
            let changes = motor.act(&turning, (&responses, &alone), &pair, params.h);
            self.joints[k].orientation = Some(motor);
            let mut sum = Angular::ZERO;
            for (gradient, change) in turning.gradients.iter().zip(changes) {
                sum += gradient.moments[1] * change;
            }
            self.beside(k, &place.gradient(Vector::ZERO, sum));
            // SAFETY: by the contract.
            unsafe { self.apply(1.0, sweep) };
        }
        let joint = &mut self.joints[k];
        joint.row.turning = Angular::ZERO;
        for (gradient, impulse) in turning.gradients.iter().zip(motor.impulses) {
            joint.row.turning += gradient.moments[1] * impulse;
        }
        joint.besides = screw(Vector::ZERO, joint.row.turning);
    }

    /// Solves limits and motors of a joint, and changes the impulses of all joints so that they stay solved. Returns the largest
    /// change of a rate, m/s or rad/s, and how many limits act. Once more, only those with limits.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    unsafe fn solve_singles(&mut self, k: usize, sweep: &Sweep, again: bool) -> (f32, u32) {
        let Sweep { pass, bodies, params, .. } = sweep;
        let biased = *pass == Pass::Solve;
        let (mut most, mut acting) = (0.0f32, 0);
        for number in self.joints[k].singles_from(self.first_single) {
            let (joint, single) = (&mut self.joints[k], &mut self.singles[number]);
            if again && !single.has_limits() {
                continue;
            }
            let (row, before) = (&joint.row, single.impulse());
            // SAFETY: by the contract.
            let (place, mut pair) =
                unsafe { (row.start.now(bodies, &row.ids), Pair::<f32>::load(bodies, &row.ids)) };
            let (gradient, value) = single.gradient(&place);
            if single.may_act(value, gradient.rate(&pair), params.h) {
                let alone = row.masses.response(&gradient);
                let response = self.beside(k, &gradient);
                let single = &mut self.singles[number];
                let change = single.act((&gradient, value), (&response, &alone), &mut pair, params, biased);
                most = most.max((change * response.along(&gradient)).abs());
                acting += u32::from(self.singles[number].impulses != [0.0; 2]);
                // SAFETY: by the contract.
                unsafe { self.apply(change, sweep) };
            }
            let of_b = screw(gradient.normal, gradient.moments[1]);
            let impulse = f64::from(self.singles[number].impulse() - if again { before } else { 0.0 });
            for (sum, part) in self.joints[k].besides.iter_mut().zip(of_b) {
                *sum += part * impulse;
            }
        }
        (most, acting)
    }

    /// Solves the tree for a unit impulse along a coordinate of a joint, and adds the impulse to those on its bodies. The
    /// response of the joint's bodies.
    fn beside(&mut self, k: usize, gradient: &Gradient<f32>) -> Response<f32> {
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

    /// Applies the impulses of limits and motors, and damps. What is locked begins from nothing.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    pub(super) unsafe fn warm_start(&mut self, sweep: &Sweep) {
        for joint in self.joints.iter_mut() {
            joint.row.block.iter_mut().for_each(|locked| locked.impulse = 0.0);
            if !joint.is_warm {
                continue;
            }
            let range = joint.singles_from(self.first_single);
            // SAFETY: by the contract.
            unsafe {
                let more = (&mut self.singles[range], joint.orientation.as_mut());
                joint.row.run::<0>(more, &sweep.bodies, sweep.params, sweep.pass);
            }
        }
    }

    /// Finds the inertia of bodies where they are now.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the tree.
    unsafe fn weigh(&mut self, sweep: &Sweep) {
        self.bodies.iter_mut().for_each(|body| body.least = 0.0);
        for (joint, link) in self.joints.iter().zip(&*self.links) {
            for (k, place) in link.places.into_iter().enumerate() {
                let side = joint.side(k);
                if let Some(body) = self.bodies.get_mut(place as usize) {
                    body.least += sweep.params.h * joint.load * joint.arms[side];
                }
            }
        }
        for (body, node) in self.bodies.iter_mut().zip(&mut *self.nodes) {
            // SAFETY: by the contract.
            let turn = unsafe { sweep.bodies.get(body.row).delta().1 };
            let angular = if body.turns { body.angular.rotated(turn) } else { body.angular };
            let angular = angular.scaled(body.share.min_element());
            body.now = if body.least > 0.0 { with_least_inertia(angular, body.least) } else { angular };
            *node = Node::new(inverse_of(body.linear.scale(body.share), body.now));
        }
    }
}

impl TreeJoint {
    /// Writes what the joint asks for in a pass.
    ///
    /// # Safety
    /// Until it returns, no other thread writes its bodies.
    #[inline(always)]
    unsafe fn ask<const D: usize>(&mut self, link: &mut Link, sweep: &Sweep) {
        let row = &self.row;
        // SAFETY: by the contract.
        let (place, pair) =
            unsafe { (row.start.now(&sweep.bodies, &row.ids), Pair::load(&sweep.bodies, &row.ids)) };
        let is_biased = sweep.pass == Pass::Solve;
        let mut block = Block::<f32, D>::new(&place, row.of_world(), &row.masses);
        if self.is_rod {
            block.take_distance(&place, &row.masses);
        }
        let mut count = 0;
        for i in 0..D {
            let locked = &row.block[i];
            if locked.is_locked == 0.0 {
                continue;
            }
            let (gradient, soft) = (&block.gradients[i], &locked.softening);
            let own = block.responses[i].along(gradient);
            let mut rate = gradient.rate(&pair);
            let mut softness = f64::from(own * NO_MASS);
            if is_biased {
                let error = block.values[i] - locked.target;
                let error = if i < DIM { error } else { wrapped(error) };
                let bias = soft.bias_rate * error;
                let most =
                    if i < DIM { sweep.params.max_push_speed } else { SMALL_TURN * sweep.params.inv_h };
                rate += if soft.is_spring > 0.0 { bias } else { bias.clamp(-most, most) };
                softness = f64::from(own * soft.share + soft.more);
                rate += (own * soft.share + soft.more) * locked.impulse;
            } else if soft.is_spring > 0.0 {
                (softness, rate) = (LOOSE * f64::from(own), 0.0);
            }
            let side = |side: usize, sign: f32| screw(gradient.normal * sign, gradient.moments[side] * sign);
            // The first one is the parent's, which is A if its side is 0.
            link.jacobians[self.parent_side][count] = side(0, -1.0);
            link.jacobians[1 - self.parent_side][count] = side(1, 1.0);
            (link.softness[count], link.wanted[count]) = (softness, -f64::from(rate));
            count += 1;
        }
        link.count = count;
        self.arm = place.arm();
    }

    /// Notes what the joint bears.
    fn bear(&mut self, link: &Link, sweep: &Sweep) {
        let mut sum = self.besides;
        let of_b = &link.jacobians[1 - self.parent_side];
        let locked = self.row.block.iter().filter(|locked| locked.is_locked > 0.0);
        for (locked, row) in locked.zip(of_b) {
            elimination::add(&mut sum, row, f64::from(locked.impulse));
        }
        let (force, moment) = motion(&sum);
        self.load = force.length();
        self.row.bear(force, moment - self.arm.cross(force), sweep.params);
    }
}
