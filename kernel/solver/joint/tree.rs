//! Trees of joints, solved directly in each pass.
//!
//! A pass solves what all joints of a tree lock, limit and drive at once (`elimination.rs`, `tree_single.rs`). Rows of
//! contacts, loops and other joints come before it in the solve pass, and follow and win in the relax pass.
//!
//! Being exact, the direct solution needs no warm start, and is soft at the rate of the substeps: one by one, rows that stiff
//! would explode.
#![expect(unsafe_code, reason = "bodies and joints of different trees are changed at once")]

use super::super::BodyRows;
use super::super::batch::{Filling, Pass, Sweep};
use super::super::input::RowInput;
use super::def::JointSolver;
use super::dim::{AXES, BLOCK, DOF};
use super::elimination::{Link, Node};
use super::forest::{Edge, Forest, GROUND, Span};
use super::orientation::OrientationRow;
use super::row::{Hold, Row};
use super::single::Single;
use super::table::{JointTable, Records};
use super::tree_pass::{Tree, TreeBody, TreeJoint, range};
use super::tree_scratch::{Coordinate, Scratch};
use crate::data::{BitSet, Parts};
use crate::graph::{COLOR_COUNT, ColorGraph, ConstraintKind};
use crate::math::{Vector, Width};
use crate::thread_pool::ThreadPool;
use crate::tuning::solver::FEWEST;

const KIND: ConstraintKind = ConstraintKind::Joint;

/// The trees of a step.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct JointTrees {
    /// Joints of trees, by id.
    held: BitSet,
    /// All joints, by id.
    all: BitSet,
    edges: Vec<Edge>,
    /// By row, the node of a body.
    pub(super) numbers: Vec<u32>,
    /// By node, the row of a body.
    numbered: Vec<u32>,
    pub(super) forest: Forest,
    hold: Hold,
    width: Width,
    joints: Vec<TreeJoint>,
    pub(super) singles: Vec<Single<f32>>,
    links: Vec<Link>,
    nodes: Vec<Node>,
    pub(super) bodies: Vec<TreeBody>,
    /// By tree.
    scratch: Vec<Scratch>,
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
        let constraints = input.bodies.constraints(KIND);
        // By ascending id: the order in colours depends on their history.
        for id in all.iter() {
            if !table.summary(id).may_branch {
                continue;
            }
            let nodes = constraints.get(id).bodies.map(|body| match input.row_of(body) {
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
        (self.hold, self.width) = (hold, rows.width);
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
        self.scratch.resize_with(self.scratch.len().max(self.forest.trees.len()), Scratch::default);
        self.forget_places();
        let hold = self.hold;
        let (forest, trees) = self.split();
        let constraints = from.input.bodies.constraints(KIND);
        pool.run(forest.trees.len(), |number, _| {
            let span = &forest.trees[number];
            // SAFETY: each tree is run once, and no two share a joint or a body.
            let tree = unsafe { trees.take(span, number) };
            for body in tree.bodies.iter_mut() {
                body.share = from.bearing.share(body.row);
            }
            tree.scratch.is_weighed = false;
            tree.scratch.coordinates.clear();
            tree.scratch.coordinates.resize(tree.singles.len(), Coordinate::NONE);
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
                if record.def.is_rod() {
                    row.take_rod(singles, &record.def, hold, from.params.h);
                }
                joint.is_warm = singles.iter().any(Single::is_warm) || joint.orientation.is_some();
                let place = |place: u32| if place == GROUND { GROUND } else { place - span.bodies[0] };
                let places = branch.places.map(place);
                tree.links[k].places = places;
                joint.arms = [0, 1].map(|side| row.start.arms[side].length());
                joint.load = record.reaction.force.length() * from.params.h;
                let of_tree = joint.singles_from(tree.first_single);
                for (single, at) in
                    tree.singles[of_tree.clone()].iter().zip(&mut tree.scratch.coordinates[of_tree])
                {
                    *at = Coordinate::new(single);
                }
            }
        });
    }

    /// The forest, and the columns of its trees.
    fn split(&mut self) -> (&Forest, Trees<'_>) {
        let Self { forest, width, joints, singles, links, nodes, bodies, scratch, .. } = self;
        let trees = Trees {
            width: *width,
            joints: Parts::of(joints),
            singles: Parts::of(singles),
            links: Parts::of(links),
            nodes: Parts::of(nodes),
            bodies: Parts::of(bodies),
            scratch: Parts::of(scratch),
        };
        (forest, trees)
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
                locked: 0,
                is_rod: def.is_rod(),
                parent_side: branch.parent_side,
                is_warm: false,
                arm: Vector::ZERO,
                arms: [0.0; 2],
                load: 0.0,
                besides: [0.0; DOF],
                orientation: def.orientation.is_some().then_some(OrientationRow::NONE),
                outside: [0.0; DOF],
            });
        }
        singles.clear();
        singles.resize(end as usize, Single::NONE);
        links.resize(forest.branches.len(), Link::NONE);
        nodes.resize(forest.bodies.len(), Node::new([[0.0; DOF]; DOF]));
    }

    /// Gives back the memory of buffers.
    pub(in super::super) fn give_back(&mut self) {
        self.scratch = Vec::new();
    }

    /// Notes that bodies have moved.
    pub(in super::super) fn forget_places(&mut self) {
        self.scratch.iter_mut().for_each(Scratch::forget);
    }

    /// Runs a pass over all trees.
    pub(in super::super) fn run(&mut self, sweep: &Sweep, pool: &ThreadPool) {
        if self.forest.trees.is_empty() || sweep.pass == Pass::UndoSplit {
            return;
        }
        // SAFETY: each tree is run once, and no two share a joint or a dynamic body. Of the bodies only dynamic ones are written.
        let run = |mut tree: Tree| unsafe {
            match sweep.pass {
                Pass::WarmStart => tree.warm_start(sweep),
                _ => tree.solve(sweep),
            }
        };
        self.each(pool, self.forest.trees.len(), |number| number, run);
    }

    /// Calls a function with some trees, given their different numbers.
    pub(super) fn each(
        &mut self,
        pool: &ThreadPool,
        count: usize,
        number: impl Fn(usize) -> usize + Sync,
        f: impl Fn(Tree) + Sync,
    ) {
        let (forest, trees) = self.split();
        // SAFETY: each tree is taken once, and no two share a joint or a body.
        pool.run(count, |k, _| f(unsafe { trees.take(&forest.trees[number(k)], number(k)) }));
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

/// All trees, changed by several threads.
struct Trees<'a> {
    width: Width,
    joints: Parts<'a, TreeJoint>,
    singles: Parts<'a, Single<f32>>,
    links: Parts<'a, Link>,
    nodes: Parts<'a, Node>,
    bodies: Parts<'a, TreeBody>,
    scratch: Parts<'a, Scratch>,
}

impl<'a> Trees<'a> {
    /// # Safety
    /// While a tree is in use, it may not be taken again.
    unsafe fn take(&self, span: &Span, number: usize) -> Tree<'a> {
        // SAFETY: by the contract, as no two trees share a branch, a body or a number.
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
                scratch: self.scratch.one(number),
                width: self.width,
            }
        }
    }
}
