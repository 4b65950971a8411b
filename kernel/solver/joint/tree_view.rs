//! The trees of one lane width.
#![expect(unsafe_code, reason = "trees are changed at once")]

use super::super::batch::{Filling, SolverPass, Sweep};
use super::dim::{AXES, BLOCK, DOF};
use super::elimination::{Link, Node};
use super::forest::{Forest, GROUND};
use super::orientation::OrientationRow;
use super::records::Records;
use super::row::{Hold, Stiffness};
use super::single::Single;
use super::tree_group::Group;
use super::tree_joint::{ListedBody, TreeBody, TreeJoint, range};
use super::tree_pass::{BeginStep, Tree, TreeEntry};
use super::tree_scratch::Scratch;
use crate::data::Parts;
use crate::math::{Entry, Lane, Width};

/// The ranges of a group in the columns.
#[derive(Clone, Copy, Debug)]
struct Span {
    joints: [u32; 2],
    singles: [u32; 2],
    bodies: [u32; 2],
}

/// Groups of trees, and their columns.
#[derive(Clone, Debug, Default)]
pub(super) struct TreeRows<N: Lane> {
    pub(super) groups: Vec<Group>,
    spans: Vec<Span>,
    joints: Vec<TreeJoint<N>>,
    singles: Vec<Single<N>>,
    links: Vec<Link<N>>,
    nodes: Vec<Node<N>>,
    bodies: Vec<TreeBody<N>>,
    /// By single coordinate, the impulses of its limits before blows.
    kept: Vec<[N; 2]>,
    /// Buffers of each group.
    scratch: Vec<Scratch<N>>,
}

impl<N: Entry> TreeRows<N> {
    /// Creates rows for all joints and bodies of the groups.
    pub(super) fn make_room(&mut self, forest: &Forest, records: &Records) {
        let Self { groups, spans, joints, singles, links, nodes, bodies, kept, scratch } = self;
        spans.clear();
        joints.clear();
        let (mut end, mut last) = (0, 0);
        for group in &*groups {
            let tree = &forest.trees[group[0] as usize];
            let (first, begin, first_body) = (joints.len() as u32, end, last);
            last += tree.bodies[1] - tree.bodies[0];
            for branch in &forest.branches[range(tree.branches)] {
                let summary = records.summaries[branch.id as usize];
                let start = end - begin;
                end += (0..AXES).filter(|k| summary.is_single(*k)).count() as u32;
                let (mut locks, mut locked) = ([0; BLOCK], 0);
                for k in (0..BLOCK).filter(|k| summary.is_in_block(*k) || summary.is_rod() && *k == 0) {
                    (locks[locked], locked) = (k as u8, locked + 1);
                }
                joints.push(TreeJoint {
                    singles: [start, end - begin],
                    locks,
                    locked,
                    is_rod: summary.is_rod(),
                    parent_side: branch.parent_side,
                    orientation: summary.turns().then_some(OrientationRow::NONE),
                    ..TreeJoint::none()
                });
            }
            spans.push(Span {
                joints: [first, joints.len() as u32],
                singles: [begin, end],
                bodies: [first_body, last],
            });
        }
        singles.clear();
        singles.resize(end as usize, Single::NONE);
        kept.clear();
        kept.resize(end as usize, [N::ZERO; 2]);
        links.resize(joints.len(), Link::NONE);
        nodes.resize(last as usize, Node::new([[N::ZERO; DOF]; DOF]));
        bodies.clear();
        bodies.resize(last as usize, TreeBody::none());
        scratch.resize_with(scratch.len().max(groups.len()), Scratch::default);
    }

    /// Frees the memory of everything except the groups.
    pub(super) fn give_back(&mut self) {
        let groups = core::mem::take(&mut self.groups);
        *self = Self { groups, ..Self::default() };
    }

    /// Marks positions as outdated, after bodies have moved.
    pub(super) fn forget_places(&mut self) {
        self.scratch.iter_mut().for_each(Scratch::forget);
    }

    pub(super) fn view(&mut self, width: Width, proof: N::Proof) -> TreeView<'_, N> {
        let Self { groups, spans, joints, singles, links, nodes, bodies, kept, scratch } = self;
        TreeView {
            entry: TreeEntry { width, proof },
            groups,
            spans,
            joints: Parts::of(joints),
            singles: Parts::of(singles),
            links: Parts::of(links),
            nodes: Parts::of(nodes),
            bodies: Parts::of(bodies),
            kept: Parts::of(kept),
            scratch: Parts::of(scratch),
        }
    }
}

/// Inputs for filling trees.
pub(super) struct TreeFilling<'a> {
    pub(super) forest: &'a Forest,
    pub(super) bodies: &'a [ListedBody],
    pub(super) records: &'a Records<'a>,
    pub(super) hold: Hold,
    pub(super) from: &'a Filling<'a>,
}

/// Groups of trees of any lane width, by number.
pub(super) trait Trees: Sync {
    /// Number of groups.
    fn len(&self) -> usize;

    /// Fills a group from joints and masses.
    ///
    /// # Safety
    /// Until the call returns, no other thread uses the group or its joints.
    unsafe fn fill(&self, group: usize, filling: &TreeFilling);

    /// Runs a pass over a group.
    ///
    /// # Safety
    /// Until the call returns, no other thread uses the group, reads or writes a dynamic body of its trees,
    /// or writes their other bodies.
    unsafe fn run(&self, group: usize, sweep: &Sweep);

    /// Sets the impulses of limits aside, and continues without them.
    ///
    /// # Safety
    /// Until the call returns, no other thread uses the group.
    unsafe fn begin_blows(&self, group: usize);

    /// Whether any tree of a group is due.
    fn is_due(&self, group: usize, is_due: &[bool]) -> bool;

    /// Solves the due trees of a group, without bias.
    ///
    /// # Safety
    /// As [`run`](Self::run).
    unsafe fn follow(&self, group: usize, is_due: &[bool], sweep: &Sweep);

    /// Restores the impulses of limits.
    ///
    /// # Safety
    /// As [`begin_blows`](Self::begin_blows).
    unsafe fn end_blows(&self, group: usize);

    /// Stores impulses in the joints.
    ///
    /// # Safety
    /// As [`fill`](Self::fill).
    unsafe fn store(&self, group: usize, forest: &Forest, records: &Records);
}

/// A view of [`TreeRows`]. Several threads may change its groups.
pub(super) struct TreeView<'a, N: Entry> {
    entry: TreeEntry<N>,
    groups: &'a [Group],
    spans: &'a [Span],
    joints: Parts<'a, TreeJoint<N>>,
    singles: Parts<'a, Single<N>>,
    links: Parts<'a, Link<N>>,
    nodes: Parts<'a, Node<N>>,
    bodies: Parts<'a, TreeBody<N>>,
    kept: Parts<'a, [N; 2]>,
    scratch: Parts<'a, Scratch<N>>,
}

/// The used lanes of a group, each with the number of its tree.
fn lanes(group: &Group) -> impl Iterator<Item = (usize, usize)> + '_ {
    group.iter().map(|tree| *tree as usize).enumerate().filter(|(_, tree)| *tree != GROUND as usize)
}

impl<'a, N: Entry> TreeView<'a, N> {
    /// # Safety
    /// While the trees of a group are in use, they are not taken again.
    unsafe fn take(&self, group: usize) -> Tree<'a, N> {
        let span = &self.spans[group];
        // SAFETY: by the contract, as no two groups share a range.
        unsafe {
            Tree {
                joints: self.joints.take(range(span.joints)),
                singles: self.singles.take(range(span.singles)),
                links: self.links.take(range(span.joints)),
                nodes: self.nodes.take(range(span.bodies)),
                bodies: self.bodies.take(range(span.bodies)),
                scratch: self.scratch.one(group),
                entry: self.entry,
            }
        }
    }
}

impl<N: Entry> Trees for TreeView<'_, N> {
    fn len(&self) -> usize {
        self.groups.len()
    }

    unsafe fn fill(&self, group: usize, filling: &TreeFilling) {
        let TreeFilling { forest, bodies, records, hold, from } = *filling;
        let stiffness = &Stiffness::new(hold, from.params.h);
        // SAFETY: by the contract.
        let tree = unsafe { self.take(group) };
        for (lane, number) in lanes(&self.groups[group]) {
            let span = &forest.trees[number];
            for (body, listed) in tree.bodies.iter_mut().zip(&bodies[range(span.bodies)]) {
                body.set(lane, listed, from.mass_scaling.share(listed.row));
            }
            for (k, branch) in forest.branches[range(span.branches)].iter().enumerate() {
                // SAFETY: by the contract.
                let record = &unsafe { records.joint(branch.id) };
                let joint = &mut tree.joints[k];
                let singles = &mut tree.singles[joint.singles()];
                let TreeJoint { row, orientation, .. } = joint;
                row.set((singles, orientation.as_mut()), (lane, stiffness), record, from);
                if record.summary.is_rod() {
                    row.take_rod(singles, record.def, (lane, stiffness));
                }
                let place = |place: u32| if place == GROUND { GROUND } else { place - span.bodies[0] };
                tree.links[k].places = branch.places.map(place);
                for side in 0..2 {
                    joint.arms[side].set(lane, joint.row.start.arms[side].get(lane).length());
                }
                joint.load.set(lane, record.state.reaction.force.length() * from.params.h);
            }
        }
        // SAFETY: the job has no further condition.
        unsafe { self.entry.run(BeginStep { tree, masses: from.masses }) };
    }

    unsafe fn run(&self, group: usize, sweep: &Sweep) {
        // SAFETY: by the contract.
        unsafe {
            let mut tree = self.take(group);
            match sweep.pass {
                SolverPass::WarmStart => tree.warm_start(sweep),
                _ => tree.solve(sweep),
            }
        }
    }

    unsafe fn begin_blows(&self, group: usize) {
        let singles = range(self.spans[group].singles);
        // SAFETY: by the contract.
        let (kept, singles) = unsafe { (self.kept.take(singles.clone()), self.singles.take(singles)) };
        for (kept, single) in kept.iter_mut().zip(singles) {
            *kept = core::mem::replace(&mut single.impulses, [N::ZERO; 2]);
        }
    }

    fn is_due(&self, group: usize, is_due: &[bool]) -> bool {
        lanes(&self.groups[group]).any(|(_, tree)| is_due[tree])
    }

    unsafe fn follow(&self, group: usize, is_due: &[bool], sweep: &Sweep) {
        let mut due = N::ZERO;
        for (lane, _) in lanes(&self.groups[group]).filter(|(_, tree)| is_due[*tree]) {
            due.set(lane, 1.0);
        }
        // SAFETY: by the contract.
        let mut tree = unsafe { self.take(group) };
        tree.scratch.forget();
        tree.scratch.open = due;
        // SAFETY: by the contract.
        unsafe { tree.project(sweep) };
    }

    unsafe fn end_blows(&self, group: usize) {
        let singles = range(self.spans[group].singles);
        // SAFETY: by the contract.
        let (kept, singles) = unsafe { (self.kept.take(singles.clone()), self.singles.take(singles)) };
        for (kept, single) in kept.iter().zip(singles) {
            single.impulses = *kept;
        }
    }

    unsafe fn store(&self, group: usize, forest: &Forest, records: &Records) {
        // SAFETY: by the contract.
        let tree = unsafe { self.take(group) };
        for (lane, number) in lanes(&self.groups[group]) {
            for (joint, branch) in
                tree.joints.iter().zip(&forest.branches[range(forest.trees[number].branches)])
            {
                // SAFETY: by the contract.
                let record = &mut unsafe { records.joint(branch.id) };
                joint.row.store((&tree.singles[joint.singles()], joint.orientation.as_ref()), lane, record);
            }
        }
    }
}
