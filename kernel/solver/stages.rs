//! The stages of a step, in the order they run.

use super::batch::{RowSet, with_rows};
use super::integrate::Special;
use super::prepare::{Buckets, DeepCounts, RowInput, StepRows, store_impulses};
use super::{BodyRows, InvMass, SubstepParams};
use crate::contact::ContactTable;
use crate::graph::{ColorGraph, OVERFLOW};
use crate::math::{F32x4, Lane, Vector};
use crate::table::NONE;

/// The bodies and rows of one step.
///
/// The order within every sweep: overflow contacts one by one, then the colours from low to high, so
/// that contacts with static and kinematic partners come last and win.
#[derive(Clone, Debug, Default)]
pub struct Solver {
    /// The bodies; the embedder fills them and reads them back.
    pub bodies: BodyRows,
    special: Special,
    overflow: RowSet<f32, f32>,
    overflow_held: RowSet<f32, Vector>,
    wide: RowSet<F32x4, F32x4>,
    /// Contacts of bodies held along some axes.
    wide_held: RowSet<F32x4, Vector<F32x4>>,
    /// Which of the four sets the next batch of a sweep is in, in order.
    order: Vec<(Set, u32)>,
    buckets: Buckets,
    deep: DeepCounts,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Set {
    Overflow,
    OverflowHeld,
    Wide,
    WideHeld,
}

/// What a sweep does with each row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pass {
    WarmStart,
    Solve,
    Relax,
    Restitute,
}

impl Solver {
    /// Builds the rows of all touching contacts in the colours.
    pub fn build_rows(&mut self, input: &RowInput, colors: &ColorGraph, params: &SubstepParams) {
        let Self { bodies, special, overflow, overflow_held, wide, wide_held, order, buckets, deep } = self;
        special.find(bodies);
        overflow.clear();
        overflow_held.clear();
        wide.clear();
        wide_held.clear();
        order.clear();
        // Body rows were gathered, so only they know what is held.
        let any_held = bodies.motions.iter().any(|m| m.locks.is_translation_partial());
        let motions = if any_held { bodies.motions.clone() } else { Vec::new() };
        let held = |id: &u32| {
            any_held
                && input.contacts.get(*id).bodies.iter().any(|b| {
                    *b != NONE
                        && motions[input.bodies.rows[*b as usize] as usize].locks.is_translation_partial()
                })
        };
        deep.count(input, bodies.rows.len());
        let step = &mut StepRows { bodies, params, deep, any_held, buckets };
        for id in colors.overflow() {
            let one = core::iter::once(*id);
            if held(id) {
                overflow_held.add_color(input, step, one);
            } else {
                overflow.add_color(input, step, one);
            }
            note(order, Set::Overflow, overflow.batches.len());
            note(order, Set::OverflowHeld, overflow_held.batches.len());
        }
        for color in 0..OVERFLOW {
            let contacts = colors.contacts(color).iter().copied();
            if any_held {
                wide_held.add_color(input, step, contacts.clone().filter(&held));
            }
            wide.add_color(input, step, contacts.filter(|id| !held(id)));
            note(order, Set::WideHeld, wide_held.batches.len());
            note(order, Set::Wide, wide.batches.len());
        }
    }

    /// How many wide and how many scalar rows the step has.
    pub fn row_counts(&self) -> (usize, usize) {
        (self.wide.len() + self.wide_held.len(), self.overflow.len() + self.overflow_held.len())
    }

    /// Accelerations, damping, gyroscopic torque, speed limits.
    pub fn integrate_velocities(&mut self, params: &SubstepParams) {
        self.bodies.integrate_velocities(&self.special, params.h);
    }

    /// Applies the accumulated impulses.
    pub fn warm_start(&mut self, params: &SubstepParams) {
        self.sweep(Pass::WarmStart, params);
    }

    /// Non-penetration with soft bias.
    pub fn solve(&mut self, params: &SubstepParams) {
        self.sweep(Pass::Solve, params);
    }

    /// Moves the bodies.
    pub fn integrate_positions(&mut self, params: &SubstepParams) {
        self.bodies.integrate_positions(&self.special, params.h);
    }

    /// Takes out the velocity that the bias added, and applies friction.
    pub fn relax(&mut self, params: &SubstepParams) {
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
    pub fn store_impulses(&self, contacts: &mut ContactTable) {
        store_set(&self.overflow, contacts);
        store_set(&self.overflow_held, contacts);
        store_set(&self.wide, contacts);
        store_set(&self.wide_held, contacts);
    }

    fn sweep(&mut self, pass: Pass, params: &SubstepParams) {
        let Self { bodies, overflow, overflow_held, wide, wide_held, order, .. } = self;
        for (set, batch) in order.iter() {
            match set {
                Set::Overflow => overflow.run(*batch, pass, bodies, params),
                Set::OverflowHeld => overflow_held.run(*batch, pass, bodies, params),
                Set::Wide => wide.run(*batch, pass, bodies, params),
                Set::WideHeld => wide_held.run(*batch, pass, bodies, params),
            }
        }
    }
}

/// Appends the batches of a set that are not in the order yet.
fn note(order: &mut Vec<(Set, u32)>, set: Set, batches: usize) {
    let known = order.iter().rev().find(|(s, _)| *s == set).map_or(0, |(_, b)| b + 1);
    order.extend((known..batches as u32).map(|b| (set, b)));
}

fn store_set<N: Lane, M: InvMass<N>>(set: &RowSet<N, M>, contacts: &mut ContactTable) {
    store_impulses(&set.one, contacts);
    store_impulses(&set.two, contacts);
    store_impulses(&set.four, contacts);
}

impl<N: Lane, M: InvMass<N>> RowSet<N, M> {
    fn run(&mut self, batch: u32, pass: Pass, bodies: &mut BodyRows, params: &SubstepParams) {
        let batch = self.batches[batch as usize];
        let range = batch.start as usize..(batch.start + batch.len) as usize;
        if pass == Pass::Restitute && !batch.bouncy {
            return;
        }
        let view = &bodies.view();
        with_rows!(self, batch.class, |set| {
            let rows = &mut set.rows[range.clone()];
            let bounces = &mut set.bounces[range];
            match pass {
                Pass::WarmStart => rows.iter().for_each(|row| row.warm_start(view)),
                Pass::Solve => rows.iter_mut().for_each(|row| row.solve(view, params)),
                Pass::Relax => rows.iter_mut().for_each(|row| row.relax(view, params)),
                Pass::Restitute => {
                    rows.iter_mut().zip(&mut *bounces).for_each(|(row, b)| row.restitute(view, b, params));
                }
            }
            if batch.bouncy && matches!(pass, Pass::Solve | Pass::Relax) {
                rows.iter().zip(bounces).for_each(|(row, b)| row.note_impulses(b));
            }
        });
    }
}
