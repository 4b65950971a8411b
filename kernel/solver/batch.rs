//! The interface of constraints: a batch of rows of one kind is filled, swept and stored block by block.
#![expect(unsafe_code, reason = "blocks of one stage are changed at once")]

use super::deep_overlap::DeepCounts;
use super::input::{Item, RowInput};
use super::mass_scaling::MassScaling;
use super::release::Released;
use super::struck::{Striking, Struck};
use super::{BodyRow, GainRow, MassRow, RowView, SubstepParams};
use crate::contact::ManifoldsView;
use crate::data::BitSet;
use crate::math::Vector;
use core::ops::Range;

/// The operation of a sweep over rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SolverPass {
    /// Apply the impulses of the last substep.
    WarmStart,
    /// Solve with soft bias.
    Solve,
    /// Remove split impulses from the velocities.
    UndoSplit,
    /// Solve without bias.
    Relax,
    /// Measure the gaps of contacts where blows displaced bodies.
    Measure,
}

/// A set of passes, as bits, and two flags: the rows may have an overloaded body, and a point of the rows
/// may be struck.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SolverPasses(u8);

impl SolverPasses {
    /// The passes of every constraint: warm start, solve, relax.
    pub(super) const BASIC: Self =
        Self::of(SolverPass::WarmStart).with(SolverPass::Solve).with(SolverPass::Relax);

    const OVERLOADED: u8 = 1 << 7;
    const WATCHED: u8 = 1 << 6;

    const fn of(pass: SolverPass) -> Self {
        Self(1 << pass as u8)
    }

    /// This set plus one more pass.
    pub(super) const fn with(self, pass: SolverPass) -> Self {
        Self(self.0 | Self::of(pass).0)
    }

    /// This set, flagged for rows with an overloaded body.
    pub(super) const fn overloaded(self) -> Self {
        Self(self.0 | Self::OVERLOADED)
    }

    /// This set, flagged for rows with a point that may be struck.
    pub(super) const fn watched(self) -> Self {
        Self(self.0 | Self::WATCHED)
    }

    /// Whether a point of the rows may be struck in this step.
    #[inline(always)]
    pub(super) fn are_watched(self) -> bool {
        self.0 & Self::WATCHED != 0
    }

    /// Whether the rows may have an overloaded body.
    #[inline(always)]
    pub(super) fn are_overloaded(self) -> bool {
        self.0 & Self::OVERLOADED != 0
    }

    /// Whether a pass is in the set.
    #[inline(always)]
    pub(super) fn has(self, pass: SolverPass) -> bool {
        self.0 & Self::of(pass).0 != 0
    }
}

/// Inputs for filling rows.
#[derive(Clone, Copy)]
pub(super) struct Filling<'a> {
    pub(super) input: &'a RowInput<'a>,
    pub(super) bodies: RowView<'a, BodyRow>,
    pub(super) masses: &'a [MassRow],
    pub(super) first_dynamic: u32,
    pub(super) params: &'a SubstepParams,
    pub(super) deep: &'a DeepCounts,
    pub(super) mass_scaling: &'a MassScaling,
    pub(super) released: &'a Released,
    /// As in [`BodyRows`](super::BodyRows).
    pub(super) axes: &'a [Vector],
}

/// The query of a search for struck manifolds.
#[derive(Clone, Copy)]
pub(super) struct Seek<'a> {
    pub(super) striking: Striking<'a>,
    /// Body rows that were struck since contacts were last searched, if any.
    pub(super) reached: Option<&'a BitSet>,
}

/// One pass over all rows.
pub(super) struct Sweep<'a> {
    pub(super) pass: SolverPass,
    pub(super) bodies: RowView<'a, BodyRow>,
    pub(super) gains: RowView<'a, GainRow>,
    pub(super) params: &'a SubstepParams,
}

/// Rows of one kind and shape. A batch is chosen once per block, so the indirect call costs nothing.
pub(super) trait Batch: Sync {
    /// Fills rows from items: one item per lane, fewer in the last row. Returns the passes that the rows
    /// need. May be called again after masses changed.
    ///
    /// # Safety
    /// Until the call returns, no other thread uses these rows, or writes their bodies or contacts.
    unsafe fn fill(&self, rows: Range<usize>, items: &[Item], from: &Filling) -> SolverPasses;

    /// Runs a pass over rows that need `passes`.
    ///
    /// # Safety
    /// Until the call returns, no other thread uses these rows, reads or writes their dynamic bodies, or
    /// writes their other bodies.
    unsafe fn run(&self, rows: Range<usize>, passes: SolverPasses, sweep: &Sweep);

    /// Watches the lanes with a struck body, and adds the lanes with a struck point to `_found`. Returns
    /// whether any lane is watched. The default is for kinds without impacts: it adds nothing.
    ///
    /// # Safety
    /// Until the call returns, no other thread uses these rows, or writes their bodies.
    unsafe fn find_struck(
        &self,
        _rows: Range<usize>,
        _block: (&[Item], SolverPasses),
        _seek: &Seek,
        _found: &mut Vec<Struck>,
    ) -> bool {
        false
    }

    /// Stores the impulses of rows in the constraints of their items.
    ///
    /// # Safety
    /// Until the call returns, no other thread uses these rows, or reads or writes their constraints.
    unsafe fn store(&self, rows: Range<usize>, items: &[Item], contacts: &ManifoldsView);
}
