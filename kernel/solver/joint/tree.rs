//! Trees of joints, solved directly in each pass.
//!
//! A pass solves what all joints of a tree lock at once (`elimination.rs`), then limits and motors one by one, each by the response
//! of the whole tree. Rows of contacts, loops and other joints follow, and win.
//!
//! Being exact, the direct solution needs no warm start, and is soft at the rate of the substeps: one by one, rows that stiff
//! would explode.
#![expect(unsafe_code, reason = "bodies and joints of different trees are changed at once")]

use super::super::BodyRows;
use super::super::batch::{Filling, Pass, Sweep};
use super::super::input::RowInput;
use super::super::pair::Pair;
use super::block::{Block, wrapped};
use super::def::JointSolver;
use super::dim::{AXES, BLOCK, DOF, inverse_of, motion, screw, with_least_inertia};
use super::elimination::{self, Link, Node, Screw};
use super::forest::{Edge, Forest, GROUND, Span};
use super::orientation::OrientationRow;
use super::place::{Gradient, Response};
use super::row::{Hold, NOT_SOFT, Row};
use super::single::Single;
use super::table::{JointTable, Records};
use crate::data::{BitSet, Parts};
use crate::graph::{COLOR_COUNT, ColorGraph, ConstraintKind};
use crate::math::{Angular, DIM, InvInertia, Vector};
use crate::thread_pool::ThreadPool;
use core::ops::Range;

const KIND: ConstraintKind = ConstraintKind::Joint;

/// Minimum number of joints of a tree. Fewer are solved as well one by one.
const FEWEST: usize = 3;

/// Largest angle that is taken back in a substep, rad. Bodies that turn farther gain energy.
const MOST_TURN: f32 = 0.25;

/// Softness of a spring in the relax pass, where it takes no part, as a multiple of its inverse mass.
const LOOSE: f64 = 1.0e12;

/// The trees of a step.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct JointTrees {
    /// Joints of trees, by id.
    held: BitSet,
    /// All joints, by id.
    all: BitSet,
    edges: Vec<Edge>,
    /// By row, the node of a body.
    numbers: Vec<u32>,
    /// By node, the row of a body.
    numbered: Vec<u32>,
    forest: Forest,
    hold: Hold,
    joints: Vec<TreeJoint>,
    singles: Vec<Single<f32>>,
    links: Vec<Link>,
    nodes: Vec<Node>,
    bodies: Vec<TreeBody>,
}

/// A body of a tree, as it is without what contacts add to its mass.
#[derive(Clone, Copy, Debug)]
struct TreeBody {
    row: u32,
    /// Inverse mass along each world axis, 1/kg. 0 along locked axes.
    linear: Vector,
    /// At the start of the step.
    angular: InvInertia,
    /// The share of the inverse mass along each axis that is left, as contacts see it.
    share: Vector,
    /// Whether its inertia turns with it.
    turns: bool,
    /// The same now, with what its joints ask for.
    now: InvInertia,
    /// What they ask for: h Σ |impulse| |arm|, kg·m².
    least: f32,
}

/// A joint of a tree.
#[derive(Clone, Copy, Debug)]
struct TreeJoint {
    row: Row<f32>,
    /// The range of its single coordinates.
    singles: [u32; 2],
    /// Number of coordinates up to the last that is locked.
    locked_end: usize,
    /// Its side at the parent.
    parent_side: usize,
    /// Whether it has more than what is locked: single coordinates, or damping.
    is_warm: bool,
    /// From B's centre of mass to its anchor.
    arm: Vector,
    /// Lengths from the centres of mass to the anchors.
    arms: [f32; 2],
    /// Length of the last impulse, N·s.
    load: f32,
    /// The impulse on B and its moment of what is not locked.
    besides: Screw,
    /// The orientation motor, if it has one.
    orientation: Option<OrientationRow<f32>>,
}

impl JointTrees {
    /// Whether a joint is in a tree.
    #[inline(always)]
    pub(super) fn holds(&self, id: u32) -> bool {
        !self.forest.branches.is_empty() && self.held.contains(id)
    }

    /// Whether two body rows are of one tree.
    pub(in super::super) fn connects(&self, rows: [u32; 2]) -> bool {
        if self.forest.trees.is_empty() {
            return false;
        }
        let [a, b] = rows.map(|row| match self.numbers.get(row as usize) {
            Some(node) if *node != GROUND => self.forest.owners[*node as usize],
            _ => GROUND,
        });
        a == b && a != GROUND
    }

    /// Number of joints in trees.
    pub(in super::super) fn len(&self) -> u32 {
        self.forest.branches.len() as u32
    }

    pub(in super::super) fn clear(&mut self) {
        self.forest.clear();
    }

    /// Finds the trees among all joints in the colours.
    pub(in super::super) fn find(
        &mut self,
        table: &JointTable,
        input: &RowInput,
        colors: &ColorGraph,
        (solver, rows): (JointSolver, &BodyRows),
    ) {
        self.forest.clear();
        let none = || (0..COLOR_COUNT as u8).all(|color| colors.constraints(KIND, color).is_empty());
        if solver == JointSolver::Rows || none() {
            return;
        }
        self.all.clear();
        for color in 0..COLOR_COUNT as u8 {
            colors.constraints(KIND, color).iter().for_each(|id| _ = self.all.insert(*id));
        }
        let Self { held, all, edges, numbers, numbered, forest, .. } = self;
        numbered.iter().for_each(|row| numbers[*row as usize] = GROUND);
        numbered.clear();
        edges.clear();
        // By ascending id: the order in colours depends on their history.
        for id in all.iter() {
            let def = &table.record(id).def;
            if !(0..BLOCK).any(|number| def.is_in_block(number)) || def.sets_twice() {
                continue;
            }
            let nodes = def.bodies.map(|body| match input.row_of(body) {
                row if row < rows.first_dynamic => GROUND,
                row => {
                    numbers.resize(numbers.len().max(row as usize + 1), GROUND);
                    let number = &mut numbers[row as usize];
                    if *number == GROUND {
                        *number = numbered.len() as u32;
                        numbered.push(row);
                    }
                    *number
                }
            });
            if nodes != [GROUND; 2] {
                edges.push(Edge { id, nodes });
            }
        }
        let (fewest, hold) = match solver {
            JointSolver::Rigid => (1, Hold::Exact),
            _ => (FEWEST, Hold::Tree),
        };
        self.hold = hold;
        forest.build(edges, numbered.len(), fewest);
        held.clear();
        forest.branches.iter().for_each(|branch| _ = held.insert(branch.id));
        self.bodies.clear();
        self.bodies.extend(forest.bodies.iter().map(|node| TreeBody::new(numbered[*node as usize], rows)));
    }

    /// Fills all trees from joints and masses.
    pub(in super::super) fn fill(&mut self, records: &Records, from: &Filling, pool: &ThreadPool) {
        if self.forest.trees.is_empty() {
            return;
        }
        self.make_room(records);
        let (forest, hold) = (&self.forest, self.hold);
        let trees = &Trees {
            joints: Parts::of(&mut self.joints),
            singles: Parts::of(&mut self.singles),
            links: Parts::of(&mut self.links),
            nodes: Parts::of(&mut self.nodes),
            bodies: Parts::of(&mut self.bodies),
        };
        let constraints = from.input.bodies.constraints(KIND);
        pool.run(forest.trees.len(), |number, _| {
            let span = &forest.trees[number];
            // SAFETY: each tree is run once, and no two share a joint or a body.
            let tree = unsafe { trees.take(span) };
            for body in tree.bodies.iter_mut() {
                body.share = from.bearing.share(body.row);
            }
            for (k, branch) in forest.branches[range(span.branches)].iter().enumerate() {
                // SAFETY: as above.
                let record = unsafe { records.0.one(branch.id as usize) };
                let singles = &mut tree.singles[tree.joints[k].singles_from(tree.first_single)];
                let joint = &mut tree.joints[k];
                let row = &mut joint.row;
                row.set(
                    (singles, joint.orientation.as_mut()),
                    (0, hold),
                    record,
                    constraints.get(branch.id).bodies,
                    from,
                );
                row.finish(from.masses);
                joint.is_warm = !singles.is_empty() || joint.orientation.is_some() || row.damping != [0.0; 2];
                let place = |place: u32| if place == GROUND { GROUND } else { place - span.bodies[0] };
                let places = branch.places.map(place);
                tree.links[k].places = places;
                joint.arms = [0, 1].map(|side| row.start.arms[side].length());
                joint.load = record.reaction.force.length() * from.params.h;
            }
        });
    }

    fn make_room(&mut self, records: &Records) {
        let Self { forest, joints, singles, links, nodes, .. } = self;
        joints.clear();
        let mut end = 0;
        for branch in &forest.branches {
            // SAFETY: no other thread runs.
            let def = unsafe { &records.0.one(branch.id as usize).def };
            let start = end;
            end += (0..AXES).filter(|k| def.is_single(*k)).count() as u32;
            joints.push(TreeJoint {
                row: Row::default(),
                singles: [start, end],
                locked_end: (0..BLOCK).rev().find(|k| def.is_in_block(*k)).map_or(0, |last| last + 1),
                parent_side: branch.parent_side,
                is_warm: false,
                arm: Vector::ZERO,
                arms: [0.0; 2],
                load: 0.0,
                besides: [0.0; DOF],
                orientation: def.orientation.is_some().then_some(OrientationRow::NONE),
            });
        }
        singles.clear();
        singles.resize(end as usize, Single::NONE);
        links.resize(forest.branches.len(), Link::NONE);
        nodes.resize(forest.bodies.len(), Node::new([[0.0; DOF]; DOF]));
    }

    /// Runs a pass over all trees.
    pub(in super::super) fn run(&mut self, sweep: &Sweep, pool: &ThreadPool) {
        if self.forest.trees.is_empty() || sweep.pass == Pass::UndoSplit {
            return;
        }
        let forest = &self.forest;
        let trees = &Trees {
            joints: Parts::of(&mut self.joints),
            singles: Parts::of(&mut self.singles),
            links: Parts::of(&mut self.links),
            nodes: Parts::of(&mut self.nodes),
            bodies: Parts::of(&mut self.bodies),
        };
        pool.run(forest.trees.len(), |number, _| {
            let span = &forest.trees[number];
            // SAFETY: each tree is run once, and no two share a joint or a dynamic body. Of the bodies only dynamic ones are
            // written.
            unsafe {
                let mut tree = trees.take(span);
                if sweep.pass == Pass::WarmStart {
                    tree.warm_start(sweep);
                } else {
                    tree.solve(sweep);
                }
            }
        });
    }

    /// Stores impulses in the joints.
    pub(in super::super) fn store(&mut self, records: &Records) {
        for (branch, joint) in self.forest.branches.iter().zip(&self.joints) {
            // SAFETY: no other thread runs.
            let record = unsafe { records.0.one(branch.id as usize) };
            joint.row.store((&self.singles[range(joint.singles)], joint.orientation.as_ref()), 0, record);
        }
    }
}

fn range([start, end]: [u32; 2]) -> Range<usize> {
    start as usize..end as usize
}

impl TreeBody {
    fn new(row: u32, rows: &BodyRows) -> Self {
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
    fn singles_from(&self, first: u32) -> Range<usize> {
        range(self.singles.map(|end| end - first))
    }
}

/// All trees, changed by several threads.
struct Trees<'a> {
    joints: Parts<'a, TreeJoint>,
    singles: Parts<'a, Single<f32>>,
    links: Parts<'a, Link>,
    nodes: Parts<'a, Node>,
    bodies: Parts<'a, TreeBody>,
}

/// One tree.
struct Tree<'a> {
    joints: &'a mut [TreeJoint],
    singles: &'a mut [Single<f32>],
    first_single: u32,
    links: &'a mut [Link],
    nodes: &'a mut [Node],
    bodies: &'a mut [TreeBody],
}

impl<'a> Trees<'a> {
    /// # Safety
    /// While a tree is in use, it may not be taken again.
    unsafe fn take(&self, span: &Span) -> Tree<'a> {
        // SAFETY: by the contract, as no two trees share a branch or a body.
        unsafe {
            let joints = self.joints.take(range(span.branches));
            let [first, last] = [0, joints.len() - 1];
            let singles = [joints[first].singles[0], joints[last].singles[1]];
            Tree {
                singles: self.singles.take(range(singles)),
                first_single: singles[0],
                joints,
                links: self.links.take(range(span.branches)),
                nodes: self.nodes.take(range(span.bodies)),
                bodies: self.bodies.take(range(span.bodies)),
            }
        }
    }
}

impl Tree<'_> {
    /// Solves all that is locked, then limits and motors.
    ///
    /// # Safety
    /// Until it returns, no other thread reads or writes the dynamic bodies of the tree, or writes its other bodies.
    unsafe fn solve(&mut self, sweep: &Sweep) {
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
            self.apply(1.0, sweep, sweep.pass == Pass::Solve);
            for k in 0..self.joints.len() {
                self.turn(k, sweep);
                self.solve_singles(k, sweep);
            }
        }
        for (joint, link) in self.joints.iter_mut().zip(&*self.links) {
            joint.bear(link, sweep);
        }
    }

    /// Applies what was solved, some times. Impulses begin anew, or add to those before.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    unsafe fn apply(&mut self, times: f32, sweep: &Sweep, is_new: bool) {
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
                let impulse = *impulse as f32 * times;
                locked.impulse = if is_new { impulse } else { locked.impulse + impulse };
            }
        }
    }

    /// Solves the orientation motor of a joint, and changes the impulses of all joints so that they stay solved.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    unsafe fn turn(&mut self, k: usize, sweep: &Sweep) {
        self.joints[k].besides = [0.0; DOF];
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
            unsafe { self.apply(1.0, sweep, false) };
        }
        let joint = &mut self.joints[k];
        joint.row.turning = Angular::ZERO;
        for (gradient, impulse) in turning.gradients.iter().zip(motor.impulses) {
            joint.row.turning += gradient.moments[1] * impulse;
        }
        joint.besides = screw(Vector::ZERO, joint.row.turning);
    }

    /// Solves limits and motors of a joint, and changes the impulses of all joints so that they stay solved.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    unsafe fn solve_singles(&mut self, k: usize, sweep: &Sweep) {
        let Sweep { pass, bodies, params } = sweep;
        let biased = *pass == Pass::Solve;
        for number in self.joints[k].singles_from(self.first_single) {
            let (joint, single) = (&mut self.joints[k], &mut self.singles[number]);
            let row = &joint.row;
            // SAFETY: by the contract.
            let (place, mut pair) =
                unsafe { (row.start.now(bodies, &row.ids), Pair::<f32>::load(bodies, &row.ids)) };
            let (gradient, value) = single.gradient(&place);
            if single.may_act(value, gradient.rate(&pair), params.h) {
                let alone = row.masses.response(&gradient);
                let response = self.beside(k, &gradient);
                let single = &mut self.singles[number];
                let change = single.act((&gradient, value), (&response, &alone), &mut pair, params, biased);
                // SAFETY: by the contract.
                unsafe { self.apply(change, sweep, false) };
            }
            let of_b = screw(gradient.normal, gradient.moments[1]);
            let impulse = f64::from(self.singles[number].impulse());
            for (sum, part) in self.joints[k].besides.iter_mut().zip(of_b) {
                *sum += part * impulse;
            }
        }
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
    unsafe fn warm_start(&mut self, sweep: &Sweep) {
        for joint in self.joints.iter_mut().filter(|joint| joint.is_warm) {
            let range = joint.singles_from(self.first_single);
            joint.row.block.iter_mut().for_each(|locked| locked.impulse = 0.0);
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
        let block = Block::<f32, D>::new(&place, row.of_world(), &row.masses);
        let mut count = 0;
        for i in 0..D {
            let locked = &row.block[i];
            if locked.is_locked == 0.0 {
                continue;
            }
            let (gradient, soft) = (&block.gradients[i], &locked.softening);
            let own = block.responses[i].along(gradient);
            let mut rate = gradient.rate(&pair);
            let mut softness = f64::from(own * NOT_SOFT);
            if is_biased {
                let error = block.values[i] - locked.target;
                let error = if i < DIM { error } else { wrapped(error) };
                let bias = soft.bias_rate * error;
                let most = if i < DIM { sweep.params.max_push_speed } else { MOST_TURN * sweep.params.inv_h };
                rate += if soft.is_spring > 0.0 { bias } else { bias.clamp(-most, most) };
                softness = f64::from(own * soft.share + soft.more);
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
