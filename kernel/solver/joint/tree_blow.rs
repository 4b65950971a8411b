//! The effect of blows on trees of joints.
//!
//! A blow changes the velocities of single bodies. The tree passes it on to all of its bodies at once;
//! these may strike other contacts, and so on in turns. Each turn is a projection, so no energy is gained.
//! All bodies of a tree move with their old velocities until the first blow on the tree: otherwise, joints
//! would open by the distance moved between the start of the substep and the blow, up to 4 cm at 10 m/s.
#![expect(unsafe_code, reason = "bodies and joints of different trees are changed at once")]

use super::super::batch::Sweep;
use super::super::blow::Blows;
use super::super::{BodyRow, RowView};
use super::forest::GROUND;
use super::tree::JointTrees;
use super::tree_joint::range;
use crate::math::{Angular, Rot, Vector, min};
use crate::thread_pool::ThreadPool;

/// State of the trees during blows. Buffers are kept between steps.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct TreeBlows {
    /// Whether the velocities before blows are stored, which happens at the first contact of a substep that
    /// closes fast.
    pub(in super::super) has_begun: bool,
    /// By tree, the time of its first blow from the start of the substep, in seconds. `f32::MAX` if the
    /// tree was not struck.
    times: Vec<f32>,
    /// By tree, whether it was struck since it was last solved.
    is_due: Vec<bool>,
    /// By body of the trees, velocity and displacement before all blows.
    before: Vec<Motion>,
    /// By body of the trees, velocity before its tree was last solved.
    earlier: Vec<(Vector, Angular)>,
}

/// Velocity, and displacement and rotation since the start of the step.
type Motion = ((Vector, Angular), (Vector, Rot));

/// Displaces a body as if its velocity had changed after `time` seconds instead of at once.
fn displace(row: &mut BodyRow, (v, w): (Vector, Angular), (position, rotation): (Vector, Rot), time: f32) {
    let now = row.velocity();
    row.set_delta(position + (v - now.0) * time, rotation.turned_by((w - now.1) * time));
}

impl TreeBlows {
    /// Starts the blows of a substep. Limits start without impulses.
    pub(in super::super) fn begin(&mut self, trees: &mut JointTrees, bodies: &RowView<BodyRow>) {
        let JointTrees { forest, bodies: listed, .. } = &*trees;
        let Self { has_begun, times, is_due, before, earlier } = self;
        *has_begun = true;
        times.clear();
        times.resize(forest.trees.len(), f32::MAX);
        is_due.clear();
        is_due.resize(forest.trees.len(), false);
        before.clear();
        // SAFETY: no other thread writes bodies.
        before.extend(listed.iter().map(|body| unsafe {
            let row = bodies.get(body.row);
            (row.velocity(), row.delta())
        }));
        earlier.clear();
        earlier.extend(before.iter().map(|(velocity, _)| *velocity));
        // SAFETY: no other thread runs.
        trees.with(|_, _, trees| unsafe {
            trees.iter().for_each(|trees| (0..trees.len()).for_each(|group| trees.begin_blows(group)));
        });
    }

    /// Marks the trees of struck body rows, and adds the bodies of these trees to the struck ones. `times`
    /// holds the rows with the times of their blows. Returns whether any tree was struck.
    pub(in super::super) fn mark(
        &mut self,
        trees: &JointTrees,
        Blows { times, reached, reached_anew, .. }: &mut Blows,
    ) -> bool {
        let mut any = false;
        for (row, time) in times.drain(..) {
            let node = trees.numbers.get(row as usize).copied().unwrap_or(GROUND);
            let Some(tree) = trees.forest.owners.get(node as usize).copied().filter(|tree| *tree != GROUND)
            else {
                continue;
            };
            any = true;
            let first = &mut self.times[tree as usize];
            *first = min(*first, time);
            if core::mem::replace(&mut self.is_due[tree as usize], true) {
                continue;
            }
            for body in &trees.bodies[range(trees.forest.trees[tree as usize].bodies)] {
                if reached.insert(body.row) {
                    reached_anew.insert(body.row);
                }
            }
        }
        any
    }

    /// Solves the struck trees, without bias.
    pub(in super::super) fn follow(
        &mut self,
        trees: &mut JointTrees,
        sweep: &Sweep,
        time: f32,
        pool: &ThreadPool,
    ) {
        let due: Vec<usize> = (0..self.is_due.len()).filter(|tree| self.is_due[*tree]).collect();
        for tree in &due {
            for k in range(trees.forest.trees[*tree].bodies) {
                // SAFETY: no other thread writes bodies.
                self.earlier[k] = unsafe { sweep.bodies.get(trees.bodies[k].row) }.velocity();
            }
        }
        let is_due = &self.is_due;
        trees.with(|_, _, trees| {
            let groups = trees.iter().flat_map(|trees| (0..trees.len()).map(move |group| (trees, group)));
            let due: Vec<_> = groups.filter(|(trees, group)| trees.is_due(*group, is_due)).collect();
            pool.run(due.len(), |k, _| {
                let (trees, group) = due[k];
                // SAFETY: each group is run once, and no two groups share a joint or a dynamic body. Only
                // dynamic bodies are written.
                unsafe { trees.follow(group, is_due, sweep) }
            });
        });
        for tree in due {
            self.is_due[tree] = false;
            let time = min(self.times[tree], time);
            for k in range(trees.forest.trees[tree].bodies) {
                let change = |row: &mut BodyRow| displace(row, self.earlier[k], row.delta(), time);
                // SAFETY: no other thread uses bodies.
                unsafe { sweep.bodies.put(trees.bodies[k].row, change) };
            }
        }
    }

    /// Ends the blows of a substep: the bodies of struck trees are displaced as if they had moved with
    /// their old velocities until the first blow on their tree.
    pub(in super::super) fn end(&self, trees: &mut JointTrees, bodies: &RowView<BodyRow>, time: f32) {
        trees.forget_places();
        let JointTrees { forest, bodies: listed, .. } = &*trees;
        for (span, first) in forest.trees.iter().zip(&self.times).filter(|(_, first)| **first < f32::MAX) {
            for k in range(span.bodies) {
                let (velocity, delta) = self.before[k];
                let change = |row: &mut BodyRow| displace(row, velocity, delta, min(*first, time));
                // SAFETY: no other thread uses bodies.
                unsafe { bodies.put(listed[k].row, change) };
            }
        }
        // SAFETY: no other thread runs.
        trees.with(|_, _, trees| unsafe {
            trees.iter().for_each(|trees| (0..trees.len()).for_each(|group| trees.end_blows(group)));
        });
    }
}
