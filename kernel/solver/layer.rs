//! The constraints of one colour, sorted into lists: what a stage is planned from.

use super::batch::Item;
use super::input::RowInput;
use super::shares::Shares;
use crate::math::AxisLocks;

/// Items whose dynamic bodies are all different, in a list for each part of the stage and each batch.
///
/// A contact with several manifolds has them solved one after the other, in one layer each: so a stage holds no body
/// twice.
#[derive(Clone, Debug, Default)]
pub(super) struct Layer {
    /// There may be more lists than are in use.
    lists: Vec<Vec<Item>>,
    batches: usize,
    parts: usize,
    /// The batch of each item in the order in which they were added, where that is kept.
    order: Option<Vec<u16>>,
}

impl Layer {
    /// Forgets all items. From now on there is a list for each batch of each part.
    pub(super) fn begin(&mut self, batches: usize, parts: usize) {
        (self.batches, self.parts) = (batches, parts);
        let count = batches * parts;
        self.lists.resize_with(self.lists.len().max(count), Vec::new);
        self.lists[..count].iter_mut().for_each(Vec::clear);
        if let Some(order) = &mut self.order {
            order.clear();
        }
    }

    /// As [`begin`](Self::begin) with one part, whose items keep the order in which they are added over all batches.
    pub(super) fn begin_ordered(&mut self, batches: usize) {
        self.order.get_or_insert_default();
        self.begin(batches, 1);
    }

    /// Adds an item.
    #[inline(always)]
    pub(super) fn push(&mut self, part: usize, batch: usize, item: Item) {
        debug_assert!(part < self.parts && batch < self.batches, "part {part} and batch {batch} have a list");
        self.lists[part * self.batches + batch].push(item);
        if let Some(order) = &mut self.order {
            order.push(batch as u16);
        }
    }

    /// The items of a part and batch.
    #[inline(always)]
    pub(super) fn list(&self, part: usize, batch: usize) -> &[Item] {
        &self.lists[part * self.batches + batch]
    }

    /// How many batches there are lists for.
    pub(super) fn batches(&self) -> usize {
        self.batches
    }

    /// How many parts there are lists for.
    pub(super) fn parts(&self) -> usize {
        self.parts
    }

    /// The batch of each item, in the order in which they were added.
    pub(super) fn order(&self) -> &[u16] {
        self.order.as_deref().unwrap_or_default()
    }
}

/// What constraints are sorted by.
pub(super) struct Sorter<'a> {
    pub(super) input: &'a RowInput<'a>,
    /// Which axes are held, by body row; empty where no body is held along any.
    pub(super) locks: &'a [AxisLocks],
    pub(super) shares: &'a Shares,
}

impl Sorter<'_> {
    /// Whether one of two bodies is held along some axes.
    #[inline(always)]
    pub(super) fn is_held(&self, bodies: [u32; 2]) -> bool {
        let held = |body: u32| self.locks[self.input.row_of(body) as usize].is_translation_held();
        !self.locks.is_empty() && bodies.into_iter().any(held)
    }

    /// The part that a constraint between two bodies belongs to.
    #[inline(always)]
    pub(super) fn part(&self, id: u32, bodies: [u32; 2], parts: usize) -> usize {
        if parts == 1 { 0 } else { self.shares.part(bodies.map(|body| self.input.row_of(body)), id, parts) }
    }
}
