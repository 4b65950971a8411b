//! Writes components by whole tables, in pieces that workers take.

use bevy_ecs::change_detection::{ContiguousComponentTicksMut, ContiguousMut, MaybeLocation, Mut, Tick};
use bevy_ecs::prelude::DetectChangesMut;
use core::ops::Range;

/// Number of rows of a piece.
pub(crate) const PIECE: usize = 256;

/// The ranges of rows of a table, in pieces.
pub(crate) fn pieces(rows: usize) -> impl Iterator<Item = Range<usize>> {
    (0..rows).step_by(PIECE).map(move |start| start..(start + PIECE).min(rows))
}

/// Whether Bevy records the location of changes (feature `track_location`). Pieces cannot record it, and
/// components are then written one by one.
pub(crate) fn is_change_tracked() -> bool {
    MaybeLocation::caller().into_option().is_some()
}

/// A component of some rows of a table.
pub(crate) struct Column<'a, T> {
    values: &'a mut [T],
    changed: &'a mut [Tick],
    now: Tick,
}

impl<'a, T> Column<'a, T> {
    /// The values of a table. Their change ticks are stored in `ticks`.
    pub(crate) fn new(
        column: ContiguousMut<'a, T>,
        ticks: &'a mut Option<ContiguousComponentTicksMut<'a>>,
    ) -> Self {
        let now = column.this_run_tick();
        let (values, all) = ContiguousMut::bypass_change_detection_split(column);
        Self { values, changed: ticks.insert(all).changed_mut(), now }
    }

    /// Splits off the first [`PIECE`] rows, or all rows if there are fewer.
    pub(crate) fn cut(&mut self) -> Self {
        let count = PIECE.min(self.values.len());
        let (values, changed) = (self.values.split_off_mut(..count), self.changed.split_off_mut(..count));
        Self { values: values.unwrap_or_default(), changed: changed.unwrap_or_default(), now: self.now }
    }

    /// The slot of a row. Panics for a row beyond the last.
    #[inline(always)]
    pub(crate) fn slot(&mut self, row: usize) -> Slot<'_, T> {
        Slot { value: &mut self.values[row], changed: &mut self.changed[row], now: self.now }
    }

    /// Iterates over the rows.
    pub(crate) fn slots(self) -> impl Iterator<Item = Slot<'a, T>> {
        let now = self.now;
        self.values.iter_mut().zip(self.changed).map(move |(value, changed)| Slot { value, changed, now })
    }
}

/// One entity's component in a [`Column`].
pub(crate) struct Slot<'a, T> {
    value: &'a mut T,
    changed: &'a mut Tick,
    now: Tick,
}

impl<T> Slot<'_, T> {
    /// The current value.
    #[inline(always)]
    pub(crate) fn get(&self) -> &T {
        self.value
    }

    /// Writes a value, and marks it as changed.
    #[inline(always)]
    pub(crate) fn set(self, value: T) {
        *self.value = value;
        *self.changed = self.now;
    }
}

/// A component that can be written, in a column or by itself.
pub(crate) trait Put<T> {
    /// Writes a value if it differs, and marks the component as changed.
    fn put(self, value: T);
}

impl<T: PartialEq> Put<T> for Slot<'_, T> {
    #[inline(always)]
    fn put(self, value: T) {
        if *self.value != value {
            self.set(value);
        }
    }
}

impl<T: PartialEq> Put<T> for Mut<'_, T> {
    #[inline(always)]
    fn put(mut self, value: T) {
        self.set_if_neq(value);
    }
}
