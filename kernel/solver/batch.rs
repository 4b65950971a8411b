//! The interface of what is solved: a batch of rows of one kind, filled, swept and stored block by block.
#![expect(unsafe_code, reason = "blocks of one stage are changed at once")]

use super::input::RowInput;
use super::split::DeepCounts;
use super::{BodyRow, MassRow, Motion, RowView, SubstepParams};
use crate::contact::ManifoldsView;
use crate::math::AxisLocks;
use core::ops::Range;

/// What a sweep does with each row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    /// Lets what closes fast bounce.
    Impact,
    /// Applies the impulses of the last substep.
    WarmStart,
    /// Solves with soft bias.
    Solve,
    /// Takes split impulses out of the velocities.
    UndoSplit,
    /// Solves without bias.
    Relax,
    /// Restitution after the last substep.
    Restitute,
}

/// The passes that a block takes part in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Passes(u8);

impl Passes {
    /// What every constraint needs: warm start, solve, relax.
    pub(super) const BASIC: Self = Self::of(Pass::WarmStart).with(Pass::Solve).with(Pass::Relax);

    const fn of(pass: Pass) -> Self {
        Self(1 << pass as u8)
    }

    /// These and one more.
    pub(super) const fn with(self, pass: Pass) -> Self {
        Self(self.0 | Self::of(pass).0)
    }

    /// Whether a pass is among them.
    #[inline(always)]
    pub(super) fn has(self, pass: Pass) -> bool {
        self.0 & Self::of(pass).0 != 0
    }
}

/// What one lane of a row is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Item {
    /// The constraint.
    pub(super) id: u32,
    /// Which of its rows; for contacts the number of the manifold.
    pub(super) index: u32,
}

/// What rows are filled from.
#[derive(Clone, Copy)]
pub(super) struct Filling<'a> {
    pub(super) input: &'a RowInput<'a>,
    pub(super) bodies: RowView<'a, BodyRow>,
    pub(super) masses: &'a [MassRow],
    pub(super) motions: &'a [Motion],
    pub(super) first_dynamic: u32,
    pub(super) params: &'a SubstepParams,
    pub(super) deep: &'a DeepCounts,
    /// Which axes are held, by body row; empty where no body is held along any.
    pub(super) locks: &'a [AxisLocks],
}

/// One pass over all rows.
pub(super) struct Sweep<'a> {
    pub(super) pass: Pass,
    pub(super) bodies: RowView<'a, BodyRow>,
    pub(super) params: &'a SubstepParams,
}

/// Rows of one kind and shape. It is chosen once for each block, so a call through a pointer costs nothing.
pub(super) trait Batch: Sync {
    /// Fills rows from their items: one for each lane, fewer in the last row. Returns the passes that the rows need.
    ///
    /// # Safety
    /// Meanwhile no other thread uses these rows, nor writes a body or contact that they have.
    unsafe fn fill(&self, rows: Range<usize>, items: &[Item], from: &Filling) -> Passes;

    /// Runs a pass over rows that need `passes`. Returns whether it found an impact.
    ///
    /// # Safety
    /// Meanwhile no other thread uses these rows, nor touches a dynamic body that they have, nor writes another that they
    /// have.
    unsafe fn run(&self, rows: Range<usize>, passes: Passes, sweep: &Sweep) -> bool;

    /// Puts the impulses of rows back to where their items came from.
    ///
    /// # Safety
    /// Meanwhile no other thread uses these rows, nor touches a constraint that they have.
    unsafe fn store(&self, rows: Range<usize>, items: &[Item], contacts: &ManifoldsView);
}
