//! The stages of a step, in the order they run.
#![expect(unsafe_code, reason = "blocks are filled at once, each by one member of the team")]

use super::batch::{Plan, Stage};
use super::block::Pass;
use super::exclusive::Exclusive;
use super::input::RowInput;
use super::prepare::{DeepCounts, Filler, Sorter};
use super::rows::{AllRows, Buffers, Layout};
use super::shares::Shares;
use super::{BodyRows, RowView, SubstepParams};
use crate::contact::ContactTable;
use crate::data::Parts;
use crate::graph::ColorGraph;
use crate::math::Width;
use crate::team::Team;
use core::sync::atomic::{AtomicBool, Ordering};

/// How many rows a member of a team solves at a stretch: some microseconds of work.
const BLOCK_ROWS: u32 = 32;

/// From so many rows on helpers are woken to fill and solve them.
const WORTH_WAKING: u32 = 256;

/// The bodies and rows of one step.
///
/// The order within every sweep: overflow contacts one by one, then the colours from low to high, so
/// that contacts with static and kinematic partners come last and win.
#[derive(Clone, Debug, Default)]
pub struct Solver {
    /// The bodies; the embedder fills them and reads them back.
    pub bodies: BodyRows,
    /// Who solves. The result does not depend on how many they are.
    pub team: Team,
    rows: AllRows,
    plan: Plan,
    buffers: Buffers,
    shares: Shares,
    deep: DeepCounts,
    exclusive: Exclusive,
}

impl Solver {
    /// Whether to solve with four lanes where the CPU has eight, from the next [`build_rows`](Self::build_rows) on: for
    /// comparison.
    pub fn set_narrow(&mut self, narrow: bool) {
        self.rows.width = Width::of(narrow);
    }

    /// From how many contacts a member of the team on a colour is shared by several, from the next
    /// [`build_rows`](Self::build_rows) on: so that tests need not have as many as it takes to pay.
    pub fn share_from(&mut self, contacts: usize) {
        self.shares.worth = contacts;
    }

    /// Forgets the rows of the last step, and makes room for so many [`bodies`](Self::bodies): every one of their rows is
    /// to be filled, whether or not there are contacts.
    pub fn begin_step(&mut self, kinematic: usize, dynamic: usize) {
        self.plan.begin(0, 1);
        self.bodies.reset(kinematic, dynamic);
    }

    /// Builds the rows of all touching contacts in the colours.
    ///
    /// With the graph of other contacts, or bodies that are not what they were when the contacts got their colours, all rows
    /// are solved by the caller alone, whatever that means for the motion.
    ///
    /// # Panics
    /// If a contact or body of the graph is not in the input, or a row of the input not among the [`bodies`](Self::bodies).
    pub fn build_rows(&mut self, input: &RowInput, colors: &ColorGraph, params: &SubstepParams) {
        let Self { bodies, team, rows, plan, buffers, shares, deep, exclusive } = self;
        debug_assert!(params.is_valid(), "{params:?}");
        debug_assert!(bodies.are_finite(), "rows of bodies are filled with finite values");
        deep.count(input, bodies);
        exclusive.look(input, colors, bodies.first_dynamic, team);
        bodies.blunt(params.h);
        let BodyRows { rows: body_rows, masses, motions, locks, first_dynamic, .. } = bodies;
        let members = team.members();
        plan.begin(if members > 1 { BLOCK_ROWS } else { u32::MAX }, members);
        shares.divide(members, body_rows.len(), input, colors);
        let sorter = &Sorter { input, locks, shares };
        rows.lay_out(colors, &mut Layout { sorter, any_deep: deep.any(), buffers, plan, team });
        let filler = &Filler {
            input,
            view: RowView::over(body_rows, *first_dynamic),
            masses,
            motions,
            first_dynamic: *first_dynamic,
            params,
            deep,
            locks,
        };
        let many = plan.rows() >= WORTH_WAKING;
        let (sets, blocks) = (rows.view(), Parts::of(&mut plan.blocks));
        if many {
            team.wake();
        }
        team.run(blocks.len(), |block, _| {
            // SAFETY: each block is run once, and no two have a row together; bodies and contacts are only read.
            unsafe { sets.fill(blocks.one(block), filler) };
        });
    }

    /// How many stages of each sweep are shared by several members of the team.
    pub fn shared_stages(&self) -> usize {
        let shared = self.plan.stages().filter(|stage| stage.parts.is_some()).count();
        if self.exclusive.holds() { shared } else { 0 }
    }

    /// How many manifolds are solved in the step.
    pub fn manifold_count(&self) -> usize {
        self.plan.manifolds
    }

    /// Accelerations, damping, gyroscopic torque, speed limits.
    pub fn integrate_velocities(&mut self, params: &SubstepParams) {
        debug_assert!(params.is_valid(), "{params:?}");
        self.bodies.integrate_velocities(params.h, &self.team);
    }

    /// Lets what closes fast in this substep bounce, then applies the accumulated impulses.
    ///
    /// An impact runs on through a row of bodies, as in Newton's cradle: two bodies further with each sweep.
    pub fn warm_start(&mut self, params: &SubstepParams) {
        if self.plan.blocks.iter().any(|block| block.bouncy) {
            let mut sweeps = 0;
            while sweeps < IMPACT_SWEEPS && self.sweep(Pass::Impact, params) {
                sweeps += 1;
            }
        }
        self.sweep(Pass::WarmStart, params);
    }

    /// Non-penetration with soft bias.
    pub fn solve(&mut self, params: &SubstepParams) {
        self.sweep(Pass::Solve, params);
    }

    /// Moves the bodies.
    pub fn integrate_positions(&mut self, params: &SubstepParams) {
        debug_assert!(params.is_valid(), "{params:?}");
        self.bodies.integrate_positions(params.h, &self.team);
    }

    /// Takes out the velocity that the bias added, and applies friction. What pushed deep overlap out is
    /// taken back first.
    pub fn relax(&mut self, params: &SubstepParams) {
        if self.deep.any() {
            self.sweep(Pass::TakeBack, params);
        }
        self.sweep(Pass::Relax, params);
    }

    /// One whole substep.
    pub fn substep(&mut self, params: &SubstepParams) {
        self.integrate_velocities(params);
        self.warm_start(params);
        self.solve(params);
        self.integrate_positions(params);
        self.relax(params);
    }

    /// Makes what hit fast enough bounce; once, after the last substep.
    pub fn restitute(&mut self, params: &SubstepParams) {
        self.sweep(Pass::Restitute, params);
    }

    /// Puts the impulses back into the manifolds, for the next step to start from.
    pub fn store_impulses(&mut self, contacts: &mut ContactTable) {
        debug_assert!(self.plan.manifolds == 0 || !contacts.is_empty(), "the rows came from these contacts");
        let (sets, manifolds) = (self.rows.view(), contacts.manifolds_view());
        for Stage { blocks, parts } in self.plan.stages() {
            // SAFETY: each block is run once, no two have a row together, and either no contact is there twice or they are run
            // one after the other.
            let store = |block: usize, _| unsafe { sets.store(&blocks[block], &manifolds) };
            match parts {
                _ if !self.exclusive.holds() => (0..blocks.len()).for_each(|block| store(block, 0)),
                Some(parts) => self.team.run_parts(parts, store),
                None => self.team.run(blocks.len(), store),
            }
        }
        self.plan.begin(0, 1);
    }

    /// Runs all blocks, stage by stage. Returns whether any of them found an impact.
    fn sweep(&mut self, pass: Pass, params: &SubstepParams) -> bool {
        debug_assert!(params.is_valid(), "{params:?}");
        debug_assert!(
            self.plan.blocks.is_empty() || self.exclusive.first_dynamic() == self.bodies.first_dynamic(),
            "bodies have the rows that contact rows were built for"
        );
        let (sets, bodies) = (self.rows.view(), self.bodies.view(self.exclusive.first_dynamic()));
        let hit = AtomicBool::new(false);
        for Stage { blocks, parts } in self.plan.stages() {
            let solve = |block: usize, _| {
                // SAFETY: each block is run once, no two have a row together, and either no two contacts of a stage have a dynamic
                // body together or they are run one after the other. Of the bodies only the dynamic ones are written.
                if unsafe { sets.run(&blocks[block], pass, &bodies, params) } {
                    hit.store(true, Ordering::Relaxed);
                }
            };
            match parts {
                Some(parts) if self.exclusive.holds() => self.team.run_parts(parts, solve),
                _ => (0..blocks.len()).for_each(|block| solve(block, 0)),
            }
        }
        hit.into_inner()
    }
}

/// How often a substep looks for impacts that follow from impacts.
const IMPACT_SWEEPS: usize = 8;
