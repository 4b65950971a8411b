//! One tree of joints in a pass: what joints ask for, and the direct solution.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::super::BodyRows;
use super::super::batch::{Pass, Sweep};
use super::super::pair::Pair;
use super::block::{Locked, coordinates, wrapped};
use super::dim::{ANGLES, BLOCK, DOF, inverse_of, motion, numbers, of_numbers, screw, with_least_inertia};
use super::elimination::{self, Link, LinkRow, Node, Screw};
use super::forest::GROUND;
use super::orientation::OrientationRow;
use super::place::{Gradient, Place};
use super::row::Row;
use super::single::Single;
use super::tree_scratch::{Known, Scratch};
use crate::math::{Angular, DIM, InvInertia, Vector, Width};
use crate::tuning::manifold::SAME;
use crate::tuning::solver::{JOINT_ROUNDS, NO_MASS, SMALL_TURN};
use core::ops::Range;

/// Softness of a spring in the relax pass, where it takes no part, as a multiple of its inverse mass.
const LOOSE: f32 = 1.0e12;

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
    /// The same where the body is now, times the least share.
    pub(super) turned: InvInertia,
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
    /// Number of coordinates that are locked: the first rows of its link.
    pub(super) locked: usize,
    /// Whether the first coordinate of its block is the distance of the anchors.
    pub(super) is_rod: bool,
    /// Its side at the parent.
    pub(super) parent_side: usize,
    /// Whether some of its impulses are warm started.
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
    /// The velocity of its body outside of the tree, if its place is `GROUND`.
    pub(super) outside: [f32; DOF],
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
            turned: angular,
            now: angular,
            least: 0.0,
        }
    }

    /// Its inverse inertia with what its joints ask for.
    fn with_least(&self) -> InvInertia {
        if self.least > 0.0 { with_least_inertia(self.turned, self.least) } else { self.turned }
    }
}

impl TreeJoint {
    /// The side of its parent, 0, or of its child, 1.
    pub(super) fn side(&self, end: usize) -> usize {
        if end == 0 { self.parent_side } else { 1 - self.parent_side }
    }

    /// What is locked of its block.
    pub(super) fn locks(&mut self) -> impl Iterator<Item = &mut Locked<f32>> {
        self.row.block.iter_mut().filter(|locked| locked.is_locked > 0.0)
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
    pub(super) scratch: &'a mut Scratch,
    /// The width of lanes whose entry point eliminates.
    pub(super) width: Width,
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

    /// Solves all that is locked, limited and driven. What is known holds until bodies move.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    pub(super) unsafe fn project(&mut self, sweep: &Sweep) {
        if self.scratch.known == Known::Nothing {
            // SAFETY: by the contract.
            unsafe { self.place(sweep) };
        }
        self.ask_inertia(sweep.params.h);
        let is_other = |body: &TreeBody| body.now != body.with_least();
        if self.scratch.known != Known::Factors(sweep.pass) || self.bodies.iter().any(is_other) {
            // SAFETY: by the contract.
            unsafe { self.turn_bodies(sweep) };
        }
        let velocities = &mut self.scratch.velocities;
        velocities.clear();
        velocities.extend(self.bodies.iter().map(|body| {
            // SAFETY: by the contract.
            numbers(unsafe { sweep.bodies.get(body.row) }.velocity())
        }));
        for (joint, link) in self.joints.iter_mut().zip(&*self.links) {
            let Some(end) = link.places.iter().position(|place| *place == GROUND) else { continue };
            let [id] = joint.row.ids[joint.side(end)];
            // SAFETY: by the contract.
            joint.outside = numbers(unsafe { sweep.bodies.get(id) }.velocity());
        }
        let mut is_driven = self.joints.iter().all(|joint| joint.orientation.is_none());
        for round in 0..JOINT_ROUNDS {
            if self.scratch.known != Known::Factors(sweep.pass) {
                self.factor(sweep);
            }
            self.ask(sweep);
            elimination::solve(self.links, self.nodes, self.width);
            self.apply(sweep);
            // In the last rounds limits are only let go.
            let adds = 2 * round < JOINT_ROUNDS;
            if round + 1 < JOINT_ROUNDS && self.pivot(adds, sweep) {
                continue;
            }
            if core::mem::replace(&mut is_driven, true) {
                break;
            }
            // SAFETY: by the contract.
            (0..self.joints.len()).for_each(|k| unsafe { self.solve_orientation(k, sweep) });
            if round + 1 == JOINT_ROUNDS || !self.pivot(adds, sweep) {
                break;
            }
        }
        // SAFETY: by the contract.
        unsafe { self.finish(sweep) };
    }

    /// The velocities of a joint's bodies now.
    pub(super) fn pair(&self, k: usize) -> Pair<f32> {
        let joint = &self.joints[k];
        let velocity = |end: usize| {
            let place = self.links[k].places[end];
            let is_outside = place == GROUND;
            of_numbers(if is_outside { joint.outside } else { self.scratch.velocities[place as usize] })
        };
        let [a, b] = [velocity(joint.parent_side), velocity(1 - joint.parent_side)];
        Pair { v: [a.0, b.0], w: [a.1, b.1] }
    }

    /// Writes what joints ask for.
    fn ask(&mut self, sweep: &Sweep) {
        let biased = sweep.pass == Pass::Solve;
        for k in 0..self.joints.len() {
            let pair = self.pair(k);
            let (joint, link) = (&self.joints[k], &mut self.links[k]);
            joint.ask(&pair, link, sweep);
            let range = joint.singles_from(self.first_single);
            for (single, at) in self.singles[range.clone()].iter().zip(&self.scratch.coordinates[range]) {
                let Some(row) = at.row else { continue };
                let rate = at.gradient.rate(&pair);
                link.rows[row].wanted = f64::from(single.wanted(at, rate, sweep.params, biased));
            }
        }
    }

    /// Adds what was solved to velocities and impulses.
    pub(super) fn apply(&mut self, sweep: &Sweep) {
        for (velocity, node) in self.scratch.velocities.iter_mut().zip(&*self.nodes) {
            for (velocity, change) in velocity.iter_mut().zip(node.change()) {
                *velocity += change as f32;
            }
        }
        for k in 0..self.joints.len() {
            let link = &self.links[k];
            for (locked, row) in self.joints[k].locks().zip(&link.rows) {
                locked.impulse += row.impulse as f32;
            }
            let range = self.joints[k].singles_from(self.first_single);
            if self.scratch.coordinates[range.clone()].iter().all(|at| at.row.is_none()) {
                continue;
            }
            let pair = self.pair(k);
            for (single, at) in self.singles[range.clone()].iter_mut().zip(&self.scratch.coordinates[range]) {
                let Some(row) = at.row else { continue };
                let solved = (link.rows[row].impulse as f32, at.gradient.rate(&pair));
                single.share_out(at, solved, sweep.params, sweep.pass == Pass::Solve);
            }
        }
    }

    /// Finds which limits act and which motors are at their maximum. Returns whether others are than were solved for.
    fn pivot(&mut self, adds: bool, sweep: &Sweep) -> bool {
        let mut changes = core::mem::take(&mut self.scratch.changes);
        changes.clear();
        for k in 0..self.joints.len() {
            let range = self.joints[k].singles_from(self.first_single);
            if range.is_empty() {
                continue;
            }
            let pair = self.pair(k);
            for index in range {
                let (single, at) = (&mut self.singles[index], &mut self.scratch.coordinates[index]);
                let of_length = if at.gradient.normal == Vector::ZERO { SAME } else { sweep.params.max_sag };
                let solved = (at.gradient.rate(&pair), SAME * of_length / sweep.params.dt, adds);
                let change = single.pivot(at, solved, sweep.params, sweep.pass == Pass::Solve);
                changes.extend(change.map(|change| (k, index, change)));
            }
        }
        if !changes.is_empty() {
            self.scratch.known = Known::Places;
        }
        for (k, index, change) in changes.iter().filter(|(.., change)| *change != 0.0) {
            let gradient = self.scratch.coordinates[*index].gradient;
            self.push(*k, &gradient, *change);
        }
        let any = !changes.is_empty();
        self.scratch.changes = changes;
        any
    }

    /// Applies an impulse along a gradient of a joint to its two bodies alone.
    fn push(&mut self, k: usize, gradient: &Gradient<f32>, impulse: f32) {
        for (end, place) in self.links[k].places.into_iter().enumerate().filter(|(_, place)| *place != GROUND)
        {
            let side = self.joints[k].side(end);
            let impulse = if side == 0 { -impulse } else { impulse };
            let push = screw(gradient.normal * impulse, gradient.moments[side] * impulse);
            let changes = self.nodes[place as usize].moved(&push);
            for (velocity, change) in self.scratch.velocities[place as usize].iter_mut().zip(changes) {
                *velocity += change as f32;
            }
        }
    }

    /// Writes velocities and impulses.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    unsafe fn finish(&mut self, sweep: &Sweep) {
        let Scratch { velocities, coordinates, .. } = &*self.scratch;
        for (body, velocity) in self.bodies.iter().zip(velocities) {
            let (v, w) = of_numbers(*velocity);
            // SAFETY: by the contract.
            unsafe { sweep.bodies.put(body.row, |row| row.set_velocity(v, w)) };
        }
        for joint in self.joints.iter_mut() {
            let range = joint.singles_from(self.first_single);
            joint.besides = screw(Vector::ZERO, joint.row.turning);
            for (single, coordinate) in self.singles[range.clone()].iter().zip(&coordinates[range]) {
                let Gradient { normal, moments } = coordinate.gradient;
                elimination::add(&mut joint.besides, &screw(normal, moments[1]), f64::from(single.impulse()));
            }
        }
    }

    /// Applies the impulses of springs and motors, and damps. What is rigid begins from nothing.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    pub(super) unsafe fn warm_start(&mut self, sweep: &Sweep) {
        for joint in self.joints.iter_mut() {
            joint.row.block.iter_mut().for_each(|locked| locked.impulse = 0.0);
            let range = joint.singles_from(self.first_single);
            let of_joint = &mut self.singles[range.clone()];
            for single in of_joint.iter_mut().filter(|single| single.softening.is_spring == 0.0) {
                single.impulses = [0.0; 2];
            }
            // SAFETY: by the contract.
            unsafe {
                if joint.is_warm {
                    let more = (&mut self.singles[range], joint.orientation.as_mut());
                    joint.row.run::<0>(more, &sweep.bodies, sweep.params, sweep.pass);
                } else if joint.row.damping != [0.0; 2] {
                    let mut pair = Pair::load(&sweep.bodies, &joint.row.ids);
                    joint.row.damp(&mut pair);
                    pair.store(&sweep.bodies, &joint.row.ids);
                }
            }
        }
    }

    /// Finds where joints are now.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the tree.
    unsafe fn place(&mut self, sweep: &Sweep) {
        let Scratch { known, coordinates, .. } = &mut *self.scratch;
        for (joint, link) in self.joints.iter_mut().zip(&mut *self.links) {
            // SAFETY: by the contract.
            let place = unsafe { joint.row.start.now(&sweep.bodies, &joint.row.ids) };
            let range = joint.singles_from(self.first_single);
            if range.is_empty() && joint.locked_end <= DIM {
                joint.lock::<DIM>(&place, &Place::NO_ANGLES, link);
                continue;
            }
            let angles = place.angles();
            match joint.locked_end <= DIM {
                true => joint.lock::<DIM>(&place, &angles, link),
                false => joint.lock::<BLOCK>(&place, &angles, link),
            }
            for (single, at) in self.singles[range.clone()].iter_mut().zip(&mut coordinates[range]) {
                (at.gradient, at.value) = single.gradient(&place, &angles);
                // A blow may have let go a limit whose impulse was given back.
                at.limit = at.limit.or_else(|| single.limit());
            }
        }
        *known = Known::Places;
    }

    /// Sums up the inertia that joints ask for.
    fn ask_inertia(&mut self, h: f32) {
        self.bodies.iter_mut().for_each(|body| body.least = 0.0);
        for (joint, link) in self.joints.iter().zip(&*self.links) {
            for (k, place) in link.places.into_iter().enumerate() {
                let side = joint.side(k);
                if let Some(body) = self.bodies.get_mut(place as usize) {
                    body.least += h * joint.load * joint.arms[side];
                }
            }
        }
    }

    /// Finds the inertia of bodies where they are now.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the tree.
    unsafe fn turn_bodies(&mut self, sweep: &Sweep) {
        for (body, node) in self.bodies.iter_mut().zip(&mut *self.nodes) {
            // SAFETY: by the contract.
            let turn = unsafe { sweep.bodies.get(body.row).delta().1 };
            let angular = if body.turns { body.angular.rotated(turn) } else { body.angular };
            body.turned = angular.scaled(body.share.min_element());
            body.now = body.with_least();
            *node = Node::new(inverse_of(body.linear.scale(body.share), body.now));
        }
        for (joint, link) in self.joints.iter_mut().zip(&*self.links) {
            for (k, place) in link.places.into_iter().enumerate() {
                let side = joint.side(k);
                let body = self.bodies.get(place as usize);
                joint.row.masses.linear[side] =
                    body.map_or(Vector::ZERO, |body| body.linear.scale(body.share));
                joint.row.masses.angular[side] = body.map_or(InvInertia::ZERO, |body| body.now);
            }
        }
        self.scratch.known = Known::Places;
    }

    /// Gives each coordinate along which something acts a row, and factors the tree.
    fn factor(&mut self, sweep: &Sweep) {
        let biased = sweep.pass == Pass::Solve;
        if biased && !core::mem::replace(&mut self.scratch.is_weighed, true) {
            self.weigh();
        }
        for (joint, link) in self.joints.iter_mut().zip(&mut *self.links) {
            joint.soften(link, sweep.pass);
            let range = joint.singles_from(self.first_single);
            for (single, at) in self.singles[range.clone()].iter().zip(&mut self.scratch.coordinates[range]) {
                at.alone = joint.row.masses.response(&at.gradient).along(&at.gradient);
                let softness = single.softness(at, sweep.params, biased);
                at.row = softness.map(|softness| joint.add_row(&at.gradient, softness, link));
            }
        }
        elimination::factor(self.links, self.nodes, self.width);
        self.scratch.known = Known::Factors(sweep.pass);
    }

    /// Finds which mass springs and motors move that are given per mass, with all that is rigid.
    fn weigh(&mut self) {
        let mut is_factored = false;
        for k in 0..self.joints.len() {
            for index in self.joints[k].singles_from(self.first_single) {
                if !self.singles[index].is_per_mass() {
                    continue;
                }
                if !core::mem::replace(&mut is_factored, true) {
                    let joints = self.joints.iter_mut().zip(&mut *self.links);
                    joints.for_each(|(joint, link)| joint.soften(link, Pass::Relax));
                    elimination::factor(self.links, self.nodes, self.width);
                }
                let gradient = self.scratch.coordinates[index].gradient;
                let alone = self.joints[k].row.masses.response(&gradient).along(&gradient);
                let left = self.unit_response(k, &gradient).along(&gradient);
                // What is locked already, nothing moves.
                self.scratch.coordinates[index].left = if left > alone * NO_MASS { left } else { 0.0 };
            }
        }
    }
}

impl TreeJoint {
    /// Writes what is locked at a place: the rows of the link.
    #[inline(always)]
    fn lock<const D: usize>(
        &mut self,
        place: &Place<f32>,
        angles: &[(f32, Angular); ANGLES],
        link: &mut Link,
    ) {
        let (mut gradients, mut values) = coordinates::<f32, D>(place, self.row.of_world(), angles);
        if self.is_rod {
            let (distance, direction) = place.apart();
            (gradients[0], values[0]) = (place.gradient(direction, Angular::ZERO), distance);
        }
        link.count = 0;
        for i in (0..D).filter(|i| self.row.block[*i].is_locked > 0.0) {
            let (gradient, error) = (gradients[i], values[i] - self.row.block[i].target);
            let error = if i < DIM { error } else { wrapped(error) };
            let row = self.add_row(&gradient, 0.0, link);
            link.rows[row].error = error;
        }
        self.locked = link.count;
        self.arm = place.arm();
    }

    /// Adds a row to the link. Returns its number.
    fn add_row(&self, gradient: &Gradient<f32>, softness: f32, link: &mut Link) -> usize {
        let number = link.count;
        let side = |side: usize, sign: f32| numbers((gradient.normal * sign, gradient.moments[side] * sign));
        let row = &mut link.rows[number];
        // The first one is the parent's, which is A if its side is 0.
        row.jacobians[self.parent_side] = side(0, -1.0);
        row.jacobians[1 - self.parent_side] = side(1, 1.0);
        row.softness = softness;
        link.count += 1;
        number
    }

    /// The gradient of a row of the link.
    fn gradient(&self, row: &LinkRow) -> Gradient<f32> {
        let [of_a, of_b] = [self.parent_side, 1 - self.parent_side].map(|end| of_numbers(row.jacobians[end]));
        Gradient { normal: of_b.0, moments: [-of_a.1, of_b.1] }
    }

    /// Writes how soft what is locked is in a pass. The link has no other rows then.
    fn soften(&self, link: &mut Link, pass: Pass) {
        link.count = self.locked;
        let locked = self.row.block.iter().filter(|locked| locked.is_locked > 0.0);
        for (locked, row) in locked.zip(&mut link.rows) {
            let (soft, gradient) = (&locked.softening, self.gradient(row));
            let own = self.row.masses.response(&gradient).along(&gradient);
            row.softness = match pass {
                Pass::Solve => own * soft.share + soft.more,
                _ if soft.is_spring > 0.0 => LOOSE * own,
                _ => own * NO_MASS,
            };
        }
    }

    /// Writes what the joint asks for in a pass.
    fn ask(&self, pair: &Pair<f32>, link: &mut Link, sweep: &Sweep) {
        let locked = self.row.block.iter().enumerate().filter(|(_, locked)| locked.is_locked > 0.0);
        for ((i, locked), row) in locked.zip(&mut link.rows) {
            let soft = &locked.softening;
            let mut rate = self.gradient(row).rate(pair);
            if sweep.pass == Pass::Solve {
                let bias = soft.bias_rate * row.error;
                let most =
                    if i < DIM { sweep.params.max_push_speed } else { SMALL_TURN * sweep.params.inv_h };
                rate += if soft.is_spring > 0.0 { bias } else { bias.clamp(-most, most) };
                rate += row.softness * locked.impulse;
            } else if soft.is_spring > 0.0 {
                rate = 0.0;
            }
            row.wanted = -f64::from(rate);
        }
    }

    /// Notes what the joint bears.
    fn bear(&mut self, link: &Link, sweep: &Sweep) {
        let mut sum = self.besides;
        let locked = self.row.block.iter().filter(|locked| locked.is_locked > 0.0);
        for (locked, row) in locked.zip(&link.rows) {
            let of_b = row.jacobians[1 - self.parent_side].map(f64::from);
            elimination::add(&mut sum, &of_b, f64::from(locked.impulse));
        }
        let (force, moment) = motion(&sum);
        self.load = force.length();
        self.row.bear(force, moment - self.arm.cross(force), sweep.params);
    }
}
