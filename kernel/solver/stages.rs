//! The stages of a step, in the order they run.

use super::batch::{Batch, RowSet, with_rows};
use super::integrate::Special;
use super::prepare::{Buckets, DeepCounts, RowInput, StepRows, store_impulses};
use super::{BodyRows, InvMass, SubstepParams};
use crate::contact::ContactTable;
use crate::graph::{ColorGraph, OVERFLOW};
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{F32x4, Lane, Vector};

/// How many contacts are solved side by side. The results have the same bits with any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// Every CPU's: SSE2, NEON, or plain arrays.
    Four,
    /// AVX2's.
    Eight,
}

impl Default for Width {
    /// The widest that this CPU has.
    fn default() -> Self {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            return Self::Eight;
        }
        Self::Four
    }
}

/// The wide rows of one width.
#[derive(Clone, Debug)]
struct WideRows<N: Lane> {
    free: RowSet<N, N>,
    /// Contacts of bodies held along some axes.
    held: RowSet<N, Vector<N>>,
    /// Which contacts of a colour are which, kept for its memory.
    parts: [Vec<u32>; 2],
}

impl<N: Lane> Default for WideRows<N> {
    fn default() -> Self {
        Self { free: RowSet::default(), held: RowSet::default(), parts: Default::default() }
    }
}

/// The bodies and rows of one step.
///
/// The order within every sweep: overflow contacts one by one, then the colours from low to high, so
/// that contacts with static and kinematic partners come last and win.
#[derive(Clone, Debug, Default)]
pub struct Solver {
    /// The bodies; the embedder fills them and reads them back.
    pub bodies: BodyRows,
    /// How many contacts are solved side by side; [`Width::Eight`] must only be chosen where
    /// [`Width::default`] does.
    width: Width,
    special: Special,
    overflow: WideRows<f32>,
    four: WideRows<F32x4>,
    #[cfg(target_arch = "x86_64")]
    eight: WideRows<F32x8>,
    /// Which set the next batch of a sweep is in, in order.
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
    Impact,
    WarmStart,
    Solve,
    TakeBack,
    Relax,
    Restitute,
}

impl Solver {
    /// Solves with four lanes where the CPU has eight: for comparison.
    pub fn set_narrow(&mut self) {
        self.width = Width::Four;
    }

    /// Finds which bodies are held, limited in speed or turned by their own spin: once per step, after
    /// [`bodies`](Self::bodies) were filled, whether or not there are contacts.
    pub fn find_special(&mut self) {
        self.special.find(&self.bodies);
    }

    /// Builds the rows of all touching contacts in the colours.
    pub fn build_rows(&mut self, input: &RowInput, colors: &ColorGraph, params: &SubstepParams) {
        let Self { bodies, overflow, four, order, buckets, deep, .. } = self;
        overflow.free.clear();
        overflow.held.clear();
        order.clear();
        deep.count(input, bodies);
        // Body rows were gathered, so only they know what is held.
        let any_held = bodies.motions.iter().any(|m| m.locks.is_translation_partial());
        let step = &mut StepRows { bodies, params, deep, any_held, buckets };
        for id in colors.overflow() {
            let one = core::iter::once(*id);
            if step.is_held(input, *id) {
                overflow.held.add_color(input, step, one);
            } else {
                overflow.free.add_color(input, step, one);
            }
            note(order, Set::Overflow, overflow.free.batches.len());
            note(order, Set::OverflowHeld, overflow.held.batches.len());
        }
        match self.width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight => eight_lanes::build(&mut self.eight, input, colors, step, order),
            _ => four.build(input, colors, step, order),
        }
    }

    /// How many wide and how many scalar rows the step has.
    pub fn row_counts(&self) -> (usize, usize) {
        let count = |rows: (usize, usize)| rows.0 + rows.1;
        let wide = match self.width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight => (self.eight.free.len(), self.eight.held.len()),
            _ => (self.four.free.len(), self.four.held.len()),
        };
        (count(wide), self.overflow.free.len() + self.overflow.held.len())
    }

    /// Accelerations, damping, gyroscopic torque, speed limits.
    pub fn integrate_velocities(&mut self, params: &SubstepParams) {
        self.bodies.integrate_velocities(&self.special, params.h);
    }

    /// Lets what closes fast in this substep bounce, then applies the accumulated impulses.
    ///
    /// An impact runs on through a row of bodies, as in Newton's cradle: two bodies further with each sweep.
    pub fn warm_start(&mut self, params: &SubstepParams) {
        if self.any_bouncy() {
            let mut sweeps = 0;
            while sweeps < IMPACT_SWEEPS && self.sweep(Pass::Impact, params) {
                sweeps += 1;
            }
        }
        self.sweep(Pass::WarmStart, params);
    }

    fn any_bouncy(&self) -> bool {
        #[cfg(target_arch = "x86_64")]
        if self.eight.any_bouncy() {
            return true;
        }
        self.overflow.any_bouncy() || self.four.any_bouncy()
    }

    /// Non-penetration with soft bias.
    pub fn solve(&mut self, params: &SubstepParams) {
        self.sweep(Pass::Solve, params);
    }

    /// Moves the bodies.
    pub fn integrate_positions(&mut self, params: &SubstepParams) {
        self.bodies.integrate_positions(&self.special, params.h);
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
    pub fn store_impulses(&self, contacts: &mut ContactTable) {
        self.overflow.store(contacts);
        match self.width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight => eight_lanes::store(&self.eight, contacts),
            _ => self.four.store(contacts),
        }
    }

    /// Runs all batches in order. Returns whether any of them found an impact.
    fn sweep(&mut self, pass: Pass, params: &SubstepParams) -> bool {
        let Self { bodies, overflow, four, order, .. } = self;
        let mut hit = false;
        for (set, batch) in order.iter() {
            hit |= match (set, self.width) {
                (Set::Overflow, _) => overflow.free.run(*batch, pass, bodies, params),
                (Set::OverflowHeld, _) => overflow.held.run(*batch, pass, bodies, params),
                #[cfg(target_arch = "x86_64")]
                (Set::Wide, Width::Eight) => {
                    eight_lanes::run(&mut self.eight.free, *batch, pass, bodies, params)
                }
                #[cfg(target_arch = "x86_64")]
                (Set::WideHeld, Width::Eight) => {
                    eight_lanes::run(&mut self.eight.held, *batch, pass, bodies, params)
                }
                (Set::Wide, _) => four.free.run(*batch, pass, bodies, params),
                (Set::WideHeld, _) => four.held.run(*batch, pass, bodies, params),
            };
        }
        hit
    }
}

/// How often a substep looks for impacts that follow from impacts.
const IMPACT_SWEEPS: usize = 8;

impl<N: Lane> WideRows<N> {
    /// Builds the rows of all colours but overflow.
    #[inline(always)]
    fn build(
        &mut self,
        input: &RowInput,
        colors: &ColorGraph,
        step: &mut StepRows,
        order: &mut Vec<(Set, u32)>,
    ) {
        self.free.clear();
        self.held.clear();
        for color in 0..OVERFLOW {
            let contacts = colors.contacts(color);
            if step.any_held {
                self.parts.iter_mut().for_each(Vec::clear);
                for id in contacts {
                    self.parts[usize::from(step.is_held(input, *id))].push(*id);
                }
                let [free, held] = &self.parts;
                self.held.add_color(input, step, held.iter().copied());
                self.free.add_color(input, step, free.iter().copied());
            } else {
                self.free.add_color(input, step, contacts.iter().copied());
            }
            note(order, Set::WideHeld, self.held.batches.len());
            note(order, Set::Wide, self.free.batches.len());
        }
    }

    fn any_bouncy(&self) -> bool {
        let any = |batches: &[Batch]| batches.iter().any(|b| b.bouncy);
        any(&self.free.batches) || any(&self.held.batches)
    }

    #[inline(always)]
    fn store(&self, contacts: &mut ContactTable) {
        store_set(&self.free, contacts);
        store_set(&self.held, contacts);
    }
}

/// The entry points of eight lanes: everything below them is inlined and compiled for AVX2.
#[cfg(target_arch = "x86_64")]
mod eight_lanes {
    #![expect(unsafe_code, reason = "entry points for a CPU feature that was looked for")]
    use super::*;

    pub(super) fn build(
        rows: &mut WideRows<F32x8>,
        input: &RowInput,
        colors: &ColorGraph,
        step: &mut StepRows,
        order: &mut Vec<(Set, u32)>,
    ) {
        // SAFETY: this width is only chosen where the CPU has AVX2.
        unsafe { build_avx2(rows, input, colors, step, order) }
    }

    pub(super) fn run<M: InvMass<F32x8>>(
        set: &mut RowSet<F32x8, M>,
        batch: u32,
        pass: Pass,
        bodies: &mut BodyRows,
        params: &SubstepParams,
    ) -> bool {
        // SAFETY: this width is only chosen where the CPU has AVX2.
        unsafe { run_avx2(set, batch, pass, bodies, params) }
    }

    pub(super) fn store(rows: &WideRows<F32x8>, contacts: &mut ContactTable) {
        // SAFETY: this width is only chosen where the CPU has AVX2.
        unsafe { store_avx2(rows, contacts) }
    }

    #[target_feature(enable = "avx2")]
    fn store_avx2(rows: &WideRows<F32x8>, contacts: &mut ContactTable) {
        rows.store(contacts);
    }

    #[target_feature(enable = "avx2")]
    fn build_avx2(
        rows: &mut WideRows<F32x8>,
        input: &RowInput,
        colors: &ColorGraph,
        step: &mut StepRows,
        order: &mut Vec<(Set, u32)>,
    ) {
        rows.build(input, colors, step, order);
    }

    #[target_feature(enable = "avx2")]
    fn run_avx2<M: InvMass<F32x8>>(
        set: &mut RowSet<F32x8, M>,
        batch: u32,
        pass: Pass,
        bodies: &mut BodyRows,
        params: &SubstepParams,
    ) -> bool {
        set.run(batch, pass, bodies, params)
    }
}

/// Appends the batches of a set that are not in the order yet.
fn note(order: &mut Vec<(Set, u32)>, set: Set, batches: usize) {
    let known = order.iter().rev().find(|(s, _)| *s == set).map_or(0, |(_, b)| b + 1);
    order.extend((known..batches as u32).map(|b| (set, b)));
}

#[inline(always)]
fn store_set<N: Lane, M: InvMass<N>>(set: &RowSet<N, M>, contacts: &mut ContactTable) {
    store_impulses(&set.one, contacts);
    store_impulses(&set.two, contacts);
    store_impulses(&set.four, contacts);
}

impl<N: Lane, M: InvMass<N>> RowSet<N, M> {
    /// Runs one batch, and returns whether it found an impact. Plain loops, not iterator adaptors: what is to
    /// be compiled for the caller's CPU feature must be inlined into it.
    #[inline(always)]
    fn run(&mut self, batch: u32, pass: Pass, bodies: &mut BodyRows, params: &SubstepParams) -> bool {
        let batch = self.batches[batch as usize];
        let range = batch.start as usize..(batch.start + batch.len) as usize;
        let concerned = match pass {
            Pass::Impact | Pass::Restitute => batch.bouncy,
            Pass::TakeBack => batch.deep,
            _ => true,
        };
        if !concerned {
            return false;
        }
        let mut hit = false;
        let view = &bodies.view();
        with_rows!(self, batch.class, |set| {
            let rows = &mut set.rows[range.clone()];
            match pass {
                Pass::Impact => {
                    for (row, bounce) in rows.iter_mut().zip(&mut set.bounces[range.clone()]) {
                        hit |= row.impact(view, bounce, params);
                    }
                }
                Pass::WarmStart => {
                    if batch.deep {
                        for (row, deep) in rows.iter_mut().zip(&set.deeps[range.clone()]) {
                            row.cool(deep);
                        }
                    }
                    for row in rows.iter() {
                        row.warm_start(view);
                    }
                }
                Pass::Solve => {
                    if batch.deep {
                        for (row, deep) in rows.iter().zip(&mut set.deeps[range.clone()]) {
                            row.note_before(deep);
                        }
                    }
                    for row in rows.iter_mut() {
                        row.solve(view, params);
                    }
                }
                Pass::TakeBack => {
                    for (row, deep) in rows.iter_mut().zip(&set.deeps[range.clone()]) {
                        row.take_back(view, deep);
                    }
                }
                Pass::Relax if batch.bouncy => {
                    for (row, bounce) in rows.iter_mut().zip(&set.bounces[range.clone()]) {
                        row.relax(view, params, Some(bounce.restitution));
                    }
                }
                Pass::Relax => {
                    for row in rows.iter_mut() {
                        row.relax(view, params, None);
                    }
                }
                Pass::Restitute => {
                    for (row, bounce) in rows.iter_mut().zip(&mut set.bounces[range.clone()]) {
                        row.restitute(view, bounce, params);
                    }
                }
            }
            if batch.bouncy && (pass == Pass::Solve || pass == Pass::Relax) {
                for (row, bounce) in rows.iter().zip(&mut set.bounces[range]) {
                    row.note_impulses(bounce);
                }
            }
        });
        hit
    }
}
