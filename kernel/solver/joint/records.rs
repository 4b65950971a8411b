//! The view of joints for filling and storing rows.
#![expect(unsafe_code, reason = "several threads change states, each of other joints")]

use super::class::Summary;
use super::coupling::CouplingRecord;
use super::def::JointDef;
use super::state::State;
use crate::data::{Parts, prefetch};

/// All joints. Several threads may change their states.
pub(in super::super) struct Records<'a> {
    defs: &'a [JointDef],
    pub(super) summaries: &'a [Summary],
    states: Parts<'a, State>,
    couplings: Parts<'a, Option<Box<CouplingRecord>>>,
}

/// A joint with mutable state.
pub(super) struct Joint<'a> {
    pub(super) def: &'a JointDef,
    pub(super) summary: Summary,
    pub(super) state: &'a mut State,
}

impl<'a> Records<'a> {
    /// A view of the columns of a joint table.
    pub(super) fn of(
        (defs, summaries): (&'a [JointDef], &'a [Summary]),
        states: &'a mut [State],
        couplings: &'a mut [Option<Box<CouplingRecord>>],
    ) -> Self {
        Self { defs, summaries, states: Parts::of(states), couplings: Parts::of(couplings) }
    }

    /// Prefetches the definition and state of a joint.
    pub(super) fn prefetch(&self, id: u32) {
        prefetch(self.defs, id);
        self.prefetch_state(id);
    }

    /// Prefetches the state of a joint.
    pub(super) fn prefetch_state(&self, id: u32) {
        self.states.prefetch(id);
    }

    /// A joint.
    ///
    /// # Safety
    /// While the joint is in use, its state is not taken again.
    pub(super) unsafe fn joint(&self, id: u32) -> Joint<'a> {
        let (def, summary) = (&self.defs[id as usize], self.summaries[id as usize]);
        // SAFETY: by the contract.
        Joint { def, summary, state: unsafe { self.states.one(id as usize) } }
    }

    /// The coupling with an id; `None` for a joint.
    ///
    /// # Safety
    /// While the coupling is in use, it is not taken again.
    pub(super) unsafe fn coupling(&self, id: u32) -> Option<&'a mut CouplingRecord> {
        // SAFETY: by the contract.
        unsafe { self.couplings.one(id as usize) }.as_deref_mut()
    }
}
