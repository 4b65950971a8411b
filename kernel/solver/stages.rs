//! The stages of a step, in the order they run.
#![expect(unsafe_code, reason = "blocks of a stage are changed at once, each by one worker")]

use super::all_rows::{AllRows, ColorLayers, SortedTables};
use super::batch::{Filling, Seek, SolverPass, Sweep};
use super::blow::{Blows, ManifoldBlow};
use super::body::Gains;
use super::color_layer::Sorter;
use super::contact_batch::Room;
use super::custom::CustomTable;
use super::deep_overlap::DeepCounts;
use super::exclusive;
use super::input::RowInput;
use super::joint::{InertiaFloors, JointTable, JointTrees, TreeBlows};
use super::mass_scaling::MassScaling;
use super::partition::Partition;
use super::plan::{Block, Plan, Stage};
use super::release::Released;
use super::struck::Striking;
use super::{BodyRow, BodyRows, GainRow, RowView, SubstepParams};
use crate::contact::{ContactFlags, ContactTable};
use crate::data::{Parts, Slack};
use crate::graph::ColorGraph;
use crate::math::Width;
use crate::thread_pool::ThreadPool;
use crate::tuning::solver::{BLOW_SWEEPS, JOINT_ROUNDS};

/// Maximum number of rows of a block if several workers share the blocks: some microseconds of work. More
/// leaves workers idle at the end of a stage, fewer cost more claims.
const BLOCK_ROWS: u32 = 32;

/// Minimum number of rows for which waking workers pays off.
const WORTH_WAKING: u32 = 256;

/// The bodies and rows of one step.
///
/// The stages run in the thread pool that the caller passes. The result does not depend on the number of
/// its workers.
///
/// Every sweep solves overflow constraints one by one, then the colours in ascending order, so that
/// contacts with static and kinematic bodies come last and have priority.
#[derive(Clone, Debug, Default)]
pub struct Solver {
    /// The bodies. The embedder fills them and reads the results.
    pub bodies: BodyRows,
    /// Joints.
    pub joints: JointTable,
    /// Constraints of the embedder.
    pub customs: CustomTable,
    /// Trees of joints, solved directly.
    trees: JointTrees,
    /// State of the trees during blows.
    tree_blows: TreeBlows,
    inertia_floors: InertiaFloors,
    rows: AllRows,
    layers: ColorLayers,
    seen: exclusive::Seen,
    plan: Plan,
    partition: Partition,
    deep: DeepCounts,
    mass_scaling: MassScaling,
    released: Released,
    blows: Blows,
    /// Contacts that the next step must not recycle, because their bodies were moved back.
    pub(super) outdated: Vec<u32>,
    /// The first body row that constraint rows may write, as of the last [`build_rows`](Self::build_rows).
    first_dynamic: u32,
    /// Whether the embedder changed bodies since gaps were last measured.
    gaps_are_old: bool,
    /// Row counts of recent steps, by which storage is given back.
    slack: Slack,
}

impl Solver {
    /// Whether to solve with four lanes even if the CPU has eight, from the next
    /// [`build_rows`](Self::build_rows) on. For comparison.
    pub fn set_narrow(&mut self, narrow: bool) {
        self.rows.width = Width::of(narrow);
        self.bodies.width = self.rows.width;
    }

    /// Sets the minimum number of constraints per worker for which workers share a colour, from the next
    /// [`build_rows`](Self::build_rows) on. Tests lower it to share small colours.
    pub fn share_from(&mut self, constraints: usize) {
        self.partition.worth = constraints;
    }

    /// Clears the rows of the last step, and resizes [`bodies`](Self::bodies). The caller must fill every
    /// body row, with or without contacts.
    pub fn begin_step(&mut self, kinematic: usize, dynamic: usize) {
        self.plan.begin(0, 1, 0);
        self.trees.clear();
        self.outdated.clear();
        self.gaps_are_old = false;
        self.bodies.reset(kinematic, dynamic);
    }

    /// Builds the rows of all constraints in the colours: touching contacts, [`joints`](Self::joints),
    /// and [`customs`](Self::customs).
    ///
    /// # Safety
    /// No two constraints of a colour other than the overflow share a body whose row is dynamic, and no
    /// constraint is in the graph twice: otherwise two threads would write one body. This holds if
    /// contacts, colours and body kinds have been changed, since they were empty, only through one
    /// [`ContactManager`](crate::contact::ContactManager) to all three. Debug builds check it.
    ///
    /// # Panics
    /// If the graph has a contact or body that the input lacks, or the input has a row that is not among
    /// the [`bodies`](Self::bodies).
    pub unsafe fn build_rows(
        &mut self,
        input: &RowInput,
        colors: &ColorGraph,
        params: &SubstepParams,
        pool: &ThreadPool,
    ) {
        let Self { bodies, joints, trees, inertia_floors, partition, deep, first_dynamic, seen, .. } = self;
        debug_assert!(params.is_valid(), "{params:?}");
        debug_assert!(bodies.are_finite(), "rows of bodies are filled with finite values");
        if cfg!(debug_assertions) {
            exclusive::check(seen, input, colors, bodies.first_dynamic);
        }
        *first_dynamic = bodies.first_dynamic;
        deep.count(input, bodies);
        bodies.find_fast_turns(input, colors, params.h);
        trees.find(joints, input, colors, (params.joints, bodies));
        bodies.turn_inertia(0.5 * (params.dt + params.h));
        joints.raise_inertia(input, colors, (params.h, pool), &mut bodies.masses, inertia_floors);
        partition.divide(pool.workers(), *first_dynamic, input, colors);
        self.plan_rows(input, colors, pool);
        let rows = self.plan.rows().iter().sum::<u32>();
        if self.slack.is_due((rows + self.trees.len()) as usize) {
            self.rows.give_back();
            self.trees.give_back();
            (self.layers, self.plan, self.mass_scaling, self.blows) = Default::default();
            self.plan_rows(input, colors, pool);
        }
        if rows + self.trees.len() >= WORTH_WAKING {
            pool.wake();
        }
        self.mass_scaling.clear();
        self.released.find(input, &self.bodies, params);
        self.blows.begin_step();
        self.fill_rows(input, params, pool);
        let Self { bodies, trees, plan, mass_scaling, .. } = self;
        let any_overloaded = plan.blocks.iter().any(|block| block.passes.are_overloaded());
        let was_any = !input.contacts.raised_masses.is_empty();
        if (any_overloaded || was_any)
            && mass_scaling.raise_masses(input, bodies, params, |rows| trees.connects(rows))
        {
            // Bodies with a mass per axis need rows of another kind.
            self.plan_rows(input, colors, pool);
            self.fill_rows(input, params, pool);
        }
        let has_joints = self.trees.len() > 0
            || self.plan.item_counts().iter().sum::<u32>() as usize > self.manifold_count();
        if !has_joints && !self.deep.any() {
            self.bodies.gains_known = Gains::Unknown;
        }
    }

    /// Sorts the constraints of all colours into rows, and resizes the rows.
    fn plan_rows(&mut self, input: &RowInput, colors: &ColorGraph, pool: &ThreadPool) {
        let Self { bodies, joints, customs, trees, rows, layers, plan, partition, deep, .. } = self;
        let workers = pool.workers();
        let sorter = &Sorter { input, axes: &bodies.axes, partition };
        layers.sort(colors, SortedTables { joints: (joints, trees), customs }, sorter, pool);
        plan.begin(if workers > 1 { BLOCK_ROWS } else { u32::MAX }, workers, AllRows::BATCHES);
        layers.plan(rows.width, sorter, plan);
        rows.make_room(plan.rows(), Room { any_deep: deep.any(), sums: input.contacts.sum_impulses });
    }

    /// Fills the rows of all blocks.
    fn fill_rows(&mut self, input: &RowInput, params: &SubstepParams, pool: &ThreadPool) {
        let Self { bodies, joints, customs, trees, rows, layers, plan, deep, mass_scaling, released, .. } =
            self;
        let BodyRows { rows: body_rows, masses, axes, first_dynamic, .. } = bodies;
        let filling = &Filling {
            input,
            bodies: RowView::over(body_rows, *first_dynamic),
            masses,
            first_dynamic: *first_dynamic,
            params,
            deep,
            mass_scaling,
            released,
            axes,
        };
        trees.fill(&joints.records(), filling, pool);
        let mut blocks = core::mem::take(&mut plan.blocks);
        rows.with(joints, customs, |batches| {
            let blocks = Parts::of(&mut blocks);
            pool.run(blocks.len(), |block, _| {
                // SAFETY: each block is filled once, and no two blocks share a row. Bodies and contacts are
                // only read.
                unsafe {
                    let block = blocks.one(block);
                    let items = plan.items(block, layers.colors());
                    block.passes = batches[usize::from(block.batch)].fill(block.rows(), items, filling);
                }
            });
        });
        plan.blocks = blocks;
    }

    /// Number of stages per sweep that several workers share.
    pub fn shared_stages(&self) -> usize {
        self.plan.stages().filter(|stage| stage.parts.is_some()).count()
    }

    /// Number of manifolds solved in the step.
    pub fn manifold_count(&self) -> usize {
        AllRows::count_manifolds(self.plan.item_counts())
    }

    /// Integrates accelerations and damping, and applies speed limits.
    pub fn integrate_velocities(&mut self, params: &SubstepParams, pool: &ThreadPool) {
        debug_assert!(params.is_valid(), "{params:?}");
        self.bodies.integrate_velocities(params.h, pool);
    }

    /// Solves blows of manifolds that close fast in this substep, then applies the accumulated impulses.
    pub fn warm_start(&mut self, params: &SubstepParams, pool: &ThreadPool) {
        let was_struck = self.strike(params.h, params, pool);
        if core::mem::take(&mut self.gaps_are_old) || was_struck {
            self.sweep(SolverPass::Measure, params, pool);
        }
        self.bodies.enter_rows(pool);
        if !self.bodies.begin_gains(pool) {
            self.sweep(SolverPass::WarmStart, params, pool);
        }
        self.bodies.leave_rows(pool);
    }

    /// Solves constraints with soft bias.
    pub fn solve(&mut self, params: &SubstepParams, pool: &ThreadPool) {
        if core::mem::take(&mut self.gaps_are_old) {
            self.sweep(SolverPass::Measure, params, pool);
        }
        self.sweep(SolverPass::Solve, params, pool);
        self.bodies.leave_rows(pool);
    }

    /// Integrates positions.
    pub fn integrate_positions(&mut self, params: &SubstepParams, pool: &ThreadPool) {
        debug_assert!(params.is_valid(), "{params:?}");
        self.bodies.integrate_positions(params.h, pool);
        self.trees.forget_places();
    }

    /// Removes split impulses from the velocities, then solves constraints without bias, and applies
    /// friction.
    pub fn relax(&mut self, params: &SubstepParams, pool: &ThreadPool) {
        if self.plan.blocks.iter().any(|block| block.passes.has(SolverPass::UndoSplit)) {
            self.sweep(SolverPass::UndoSplit, params, pool);
        }
        self.sweep(SolverPass::Relax, params, pool);
        self.bodies.end_gains(pool);
        self.bodies.leave_rows(pool);
    }

    /// Must be called when the embedder changed velocities or displacements of [`bodies`](Self::bodies)
    /// between two stages of a step.
    pub fn follow_changes(&mut self) {
        self.gaps_are_old = true;
        // The embedder's change of velocity is no impulse, so the warm start must not repeat it.
        self.bodies.gains_known = Gains::Unused;
    }

    /// Runs one substep.
    pub fn substep(&mut self, params: &SubstepParams, pool: &ThreadPool) {
        self.integrate_velocities(params, pool);
        self.warm_start(params, pool);
        self.solve(params, pool);
        self.integrate_positions(params, pool);
        self.relax(params, pool);
    }

    /// Solves blows of manifolds that close fast and touch, after the last substep.
    pub fn restitute(&mut self, params: &SubstepParams, pool: &ThreadPool) {
        if self.strike(0.0, params, pool) {
            let BodyRows { moved, .. } = &mut self.bodies;
            self.blows.reached.iter().for_each(|row| _ = moved.insert(row));
        }
        self.bodies.leave_rows(pool);
    }

    /// Solves blows of manifolds that close fast and touch within `time` seconds. Joints of trees take
    /// part, alternating with contacts. Returns whether contacts were struck, which displaces bodies.
    fn strike(&mut self, time: f32, params: &SubstepParams, pool: &ThreadPool) -> bool {
        self.blows.elapsed += time;
        let is_watched = self.plan.blocks.iter().any(|block| block.passes.are_watched());
        if !is_watched && self.blows.reached.is_empty() {
            return false;
        }
        self.blows.begin();
        self.tree_blows.has_begun = false;
        let any = self.strike_contacts(time, params, pool);
        if self.tree_blows.has_begun {
            for _ in 0..JOINT_ROUNDS {
                let Self { trees, tree_blows, blows, .. } = self;
                if !tree_blows.mark(trees, blows) {
                    break;
                }
                self.with_true_turns(pool, |blows, trees, (bodies, gains)| {
                    let sweep = Sweep { pass: SolverPass::Relax, bodies, gains, params };
                    blows.follow(trees, &sweep, time, pool);
                });
                self.strike_contacts(time, params, pool);
            }
            self.with_true_turns(pool, |blows, trees, (bodies, _)| blows.end(trees, &bodies, time));
        }
        self.bodies.enter_rows(pool);
        self.bodies.follow_blows(&self.blows.reached, params.h);
        any
    }

    /// Calls a function with the trees and the bodies, with true angular velocities.
    fn with_true_turns(
        &mut self,
        pool: &ThreadPool,
        f: impl FnOnce(&mut TreeBlows, &mut JointTrees, (RowView<BodyRow>, RowView<GainRow>)),
    ) {
        self.bodies.leave_rows(pool);
        f(&mut self.tree_blows, &mut self.trees, self.bodies.views(self.first_dynamic));
    }

    /// Strikes the contacts that close fast, then the contacts that these blows make close fast, in rounds.
    /// Returns whether any contact was struck.
    fn strike_contacts(&mut self, time: f32, params: &SubstepParams, pool: &ThreadPool) -> bool {
        let mut any = false;
        for _ in 0..BLOW_SWEEPS {
            if self.blows.is_spent() || !self.find_struck(time, params, pool) {
                break;
            }
            if self.trees.len() > 0 && !self.tree_blows.has_begun {
                self.with_true_turns(pool, |blows, trees, (bodies, _)| blows.begin(trees, &bodies));
            }
            self.bodies.enter_rows(pool);
            let Self { bodies: BodyRows { rows, motions, width, .. }, blows, mass_scaling, .. } = self;
            let bodies = RowView::over(rows, self.first_dynamic);
            let striking = Striking { bodies, motions, mass_scaling, params, time, elapsed: blows.elapsed };
            if !blows.strike((self.first_dynamic, *width), &striking, pool) {
                break;
            }
            any = true;
        }
        any
    }

    /// Finds the contacts that close fast. Returns whether there are any.
    fn find_struck(&mut self, time: f32, params: &SubstepParams, pool: &ThreadPool) -> bool {
        self.bodies.enter_rows(pool);
        let Self { bodies, joints, customs, rows, plan, layers, blows, mass_scaling, .. } = self;
        let BodyRows { rows: body_rows, motions, .. } = bodies;
        let bodies = RowView::over(body_rows, self.first_dynamic);
        let Blows { found, reached_anew, elapsed, .. } = blows;
        let striking = Striking { bodies, motions, mass_scaling, params, time, elapsed: *elapsed };
        let seek = &Seek { striking, reached: (!reached_anew.is_empty()).then_some(reached_anew) };
        let mut blocks = core::mem::take(&mut plan.blocks);
        rows.with(joints, customs, |batches| {
            let looked_at = |block: &&mut Block| seek.reached.is_some() || block.passes.are_watched();
            pool.each_into(found, blocks.iter_mut().filter(looked_at), |found, block| {
                let items = plan.items(block, layers.colors());
                let batch = batches[usize::from(block.batch)];
                // SAFETY: each block is searched once, and bodies are only read.
                if unsafe { batch.find_struck(block.rows(), (items, block.passes), seek, found) } {
                    block.passes = block.passes.watched();
                }
            });
        });
        plan.blocks = blocks;
        reached_anew.clear();
        found.iter().any(|found| !found.is_empty())
    }

    /// The blows of the step, ordered by time and kept until the next step. A manifold may be struck
    /// several times.
    pub fn blows(&self) -> impl Iterator<Item = ManifoldBlow> {
        self.blows.given()
    }

    /// Whether the body of a row was struck in the step.
    pub fn was_struck(&self, row: u32) -> bool {
        self.blows.reached.contains(row)
    }

    /// Stores the impulses in manifolds and joints, for the warm start of the next step.
    pub fn store_impulses(&mut self, contacts: &mut ContactTable, pool: &ThreadPool) {
        debug_assert!(
            self.manifold_count() == 0 || !contacts.is_empty(),
            "the rows came from these contacts"
        );
        let Self { joints, customs, trees, rows, plan, layers, .. } = self;
        trees.store(&joints.records(), pool);
        let manifolds = &contacts.manifolds_view();
        rows.with(joints, customs, |batches| {
            for Stage { blocks, parts } in plan.stages() {
                // SAFETY: each block is stored once, no two blocks share a row, and by the contract of
                // `build_rows` each constraint occurs once.
                let store = |block: usize, _| unsafe {
                    let block = &blocks[block];
                    let items = plan.items(block, layers.colors());
                    batches[usize::from(block.batch)].store(block.rows(), items, manifolds);
                };
                match parts {
                    Some(parts) => pool.run_parts(parts, store),
                    None => pool.run(blocks.len(), store),
                }
            }
        });
        self.mass_scaling.store(contacts);
        self.blows.store(contacts);
        for id in self.outdated.drain(..) {
            contacts.get_mut(id).flags.set(ContactFlags::FROZEN, false);
        }
        self.plan.begin(0, 1, 0);
        self.trees.clear();
    }

    /// Runs a pass over all trees and rows.
    ///
    /// The solve pass ends with trees, so that bodies move as their joints allow; the relax pass ends with
    /// rows, so that contacts have the last word on velocities. Trees are stiffer than contacts. If the
    /// relax pass ended with trees, joints would close the errors that contacts open against the same
    /// contacts, and such a loop gains energy from a mass ratio of three on. Trees also come first, because
    /// they have no warm start: contacts have to see the load on the joints.
    fn sweep(&mut self, pass: SolverPass, params: &SubstepParams, pool: &ThreadPool) {
        debug_assert!(params.is_valid(), "{params:?}");
        match pass {
            SolverPass::Measure => {
                self.trees.forget_places();
                self.sweep_rows(pass, params, pool);
            }
            _ => {
                self.sweep_trees(pass, params, pool);
                self.sweep_rows(pass, params, pool);
                if pass == SolverPass::Solve && !self.plan.blocks.is_empty() {
                    self.sweep_trees(pass, params, pool);
                }
            }
        }
    }

    /// Runs a pass over all trees.
    fn sweep_trees(&mut self, pass: SolverPass, params: &SubstepParams, pool: &ThreadPool) {
        let Self { bodies, trees, first_dynamic, .. } = self;
        if trees.len() > 0 {
            // Trees use the true rotation of bodies, so they need true angular velocities.
            bodies.leave_rows(pool);
            let (rows, gains) = bodies.views(*first_dynamic);
            trees.run(&Sweep { pass, bodies: rows, gains, params }, pool);
        }
    }

    /// Runs a pass over all blocks that need it, stage by stage.
    fn sweep_rows(&mut self, pass: SolverPass, params: &SubstepParams, pool: &ThreadPool) {
        self.bodies.enter_rows(pool);
        let Self { bodies, joints, customs, rows, plan, first_dynamic, .. } = self;
        debug_assert!(
            plan.blocks.is_empty() || *first_dynamic == bodies.first_dynamic(),
            "bodies have the rows that rows of constraints were built for"
        );
        let (bodies, gains) = bodies.views(*first_dynamic);
        let sweep = &Sweep { pass, bodies, gains, params };
        rows.with(joints, customs, |batches| {
            for Stage { blocks, parts } in plan.stages() {
                let solve = |block: usize, _| {
                    let block = &blocks[block];
                    if !block.passes.has(pass) {
                        return;
                    }
                    let batch = batches[usize::from(block.batch)];
                    // SAFETY: each block is run once, no two blocks share a row, and by the contract of
                    // `build_rows` no two blocks of a shared stage have a dynamic body in common. Only
                    // dynamic bodies are written.
                    unsafe { batch.run(block.rows(), block.passes, sweep) };
                };
                match parts {
                    Some(parts) => pool.run_parts(parts, solve),
                    None => (0..blocks.len()).for_each(|block| solve(block, 0)),
                }
            }
        });
    }
}
