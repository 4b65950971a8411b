//! Trees of joints, solved directly in each pass.
//!
//! A pass solves all locked, limited and driven coordinates of a tree at once (`elimination.rs`,
//! `tree_single.rs`). Rows of contacts, loops and other joints come between the two tree solutions of the
//! solve pass, and come last in the relax pass, so that they have priority there.
//!
//! The direct solution is exact, so it needs no warm start, and its softness has the rate of the substeps:
//! rows that stiff would explode if solved one by one.
#![expect(unsafe_code, reason = "bodies and joints of different trees are changed at once")]

use super::super::BodyRows;
use super::super::batch::{Filling, SolverPass, Sweep};
use super::super::input::RowInput;
use super::def::JointSolver;
use super::forest::{Edge, Forest, GROUND};
use super::records::Records;
use super::row::Hold;
use super::table::JointTable;
use super::tree_group::Shapes;
use super::tree_joint::ListedBody;
use super::tree_view::{TreeFilling, TreeRows, Trees};
use crate::data::BitSet;
use crate::graph::{COLOR_COUNT, ColorGraph, ConstraintKind};
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{F32x4, Lane, Width};
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
    /// The edges and the minimum tree size for which the last forest was built.
    built_for: (Vec<Edge>, usize),
    /// The last forest, while `forest` is empty.
    kept: Forest,
    is_built: bool,
    /// The node of each body row.
    pub(super) numbers: Vec<u32>,
    /// The body row of each node.
    numbered: Vec<u32>,
    pub(super) forest: Forest,
    hold: Hold,
    width: Width,
    pub(super) bodies: Vec<ListedBody>,
    shapes: Shapes,
    /// Trees with a unique shape.
    ones: TreeRows<f32>,
    four: TreeRows<F32x4>,
    #[cfg(target_arch = "x86_64")]
    eight: TreeRows<F32x8>,
}

impl JointTrees {
    /// Whether a joint is in a tree.
    #[inline(always)]
    pub(super) fn holds(&self, id: u32) -> bool {
        !self.forest.branches.is_empty() && self.held.contains(id)
    }

    /// Whether two body rows belong to one tree.
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

    /// Ends a step. The forest is kept for the next step.
    pub(in super::super) fn clear(&mut self) {
        if core::mem::take(&mut self.is_built) {
            core::mem::swap(&mut self.forest, &mut self.kept);
            self.forest.clear();
        }
        self.ones.groups.clear();
        self.four.groups.clear();
        #[cfg(target_arch = "x86_64")]
        self.eight.groups.clear();
    }

    /// Finds the trees among all joints in the colours.
    pub(in super::super) fn find(
        &mut self,
        table: &JointTable,
        input: &RowInput,
        colors: &ColorGraph,
        (solver, rows): (JointSolver, &BodyRows),
    ) {
        self.clear();
        let none = || (0..COLOR_COUNT as u8).all(|color| colors.constraints(KIND, color).is_empty());
        if solver == JointSolver::Rows || none() {
            return;
        }
        self.all.clear();
        for color in 0..COLOR_COUNT as u8 {
            colors.constraints(KIND, color).iter().for_each(|id| _ = self.all.insert(*id));
        }
        let Self { held, all, edges, built_for, kept, numbers, numbered, forest, shapes, .. } = self;
        numbered.iter().for_each(|row| numbers[*row as usize] = GROUND);
        numbered.clear();
        edges.clear();
        let constraints = input.bodies.constraints(KIND);
        // In the order of ids: the order within colours depends on their history.
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
        let is_same = (&built_for.0, built_for.1) == (edges, fewest);
        if is_same {
            core::mem::swap(forest, kept);
        } else {
            forest.build(edges, numbered.len(), fewest);
            held.clear();
            forest.branches.iter().for_each(|branch| _ = held.insert(branch.id));
            core::mem::swap(&mut built_for.0, edges);
            built_for.1 = fewest;
        }
        self.is_built = true;
        self.bodies.clear();
        self.bodies.extend(forest.bodies.iter().map(|node| ListedBody::new(numbered[*node as usize], rows)));
        let shape = |id| table.summary(id).shape;
        match self.width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight(_) => {
                let groups = [&mut self.ones.groups, &mut self.eight.groups];
                shapes.group((forest, is_same), shape, F32x8::WIDTH, groups);
            }
            _ => {
                let groups = [&mut self.ones.groups, &mut self.four.groups];
                shapes.group((forest, is_same), shape, F32x4::WIDTH, groups);
            }
        }
    }

    /// Fills all trees from joints and masses.
    pub(in super::super) fn fill(&mut self, records: &Records, from: &Filling, pool: &ThreadPool) {
        if self.forest.trees.is_empty() {
            return;
        }
        self.ones.make_room(&self.forest, records);
        match self.width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight(_) => self.eight.make_room(&self.forest, records),
            _ => self.four.make_room(&self.forest, records),
        }
        self.forget_places();
        let hold = self.hold;
        self.with(|forest, bodies, trees| {
            let filling = &TreeFilling { forest, bodies, records, hold, from };
            // SAFETY: each group is filled once, and no two groups share a joint.
            each(trees, pool, |trees, group| unsafe { trees.fill(group, filling) });
        });
    }

    /// Calls a function with the groups of a single tree, and with the groups of several trees.
    pub(super) fn with(&mut self, f: impl FnOnce(&Forest, &[ListedBody], [&dyn Trees; 2])) {
        let (width, ones) = (self.width, self.ones.view(self.width, ()));
        let (forest, bodies) = (&self.forest, &self.bodies[..]);
        match width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight(avx2) => f(forest, bodies, [&ones, &self.eight.view(width, avx2)]),
            _ => f(forest, bodies, [&ones, &self.four.view(width, ())]),
        }
    }

    /// Frees the memory of buffers.
    pub(in super::super) fn give_back(&mut self) {
        self.ones.give_back();
        self.four.give_back();
        #[cfg(target_arch = "x86_64")]
        self.eight.give_back();
    }

    /// Marks positions as outdated, after bodies have moved.
    pub(in super::super) fn forget_places(&mut self) {
        self.ones.forget_places();
        self.four.forget_places();
        #[cfg(target_arch = "x86_64")]
        self.eight.forget_places();
    }

    /// Runs a pass over all trees.
    pub(in super::super) fn run(&mut self, sweep: &Sweep, pool: &ThreadPool) {
        if self.forest.trees.is_empty() || sweep.pass == SolverPass::UndoSplit {
            return;
        }
        // SAFETY: each group is run once, and no two groups share a joint or a dynamic body. Only dynamic
        // bodies are written.
        self.with(|_, _, trees| each(trees, pool, |trees, group| unsafe { trees.run(group, sweep) }));
    }

    /// Stores impulses in the joints.
    pub(in super::super) fn store(&mut self, records: &Records, pool: &ThreadPool) {
        self.with(|forest, _, trees| {
            // SAFETY: each group is stored once, and no two groups share a joint.
            each(trees, pool, |trees, group| unsafe { trees.store(group, forest, records) });
        });
    }
}

/// Calls a function with each group.
fn each(trees: [&dyn Trees; 2], pool: &ThreadPool, f: impl Fn(&dyn Trees, usize) + Sync) {
    let [ones, wide] = trees;
    pool.run(wide.len() + ones.len(), |k, _| match k.checked_sub(wide.len()) {
        None => f(wide, k),
        Some(k) => f(ones, k),
    });
}
