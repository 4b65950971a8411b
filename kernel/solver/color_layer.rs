//! The constraints of one colour, sorted into the lists from which stages are planned.

use super::input::{Item, RowInput};
use super::partition::Partition;
use crate::math::Vector;

/// Items without a common dynamic body, in one list for each part of the stage and each batch.
///
/// Each manifold of a contact is in a layer of its own, so that no stage has a body twice.
#[derive(Clone, Debug, Default)]
pub(super) struct ColorLayer {
    /// The lists. The last ones may be unused.
    lists: Vec<Vec<Item>>,
    batches: usize,
    parts: usize,
    /// The batch of each item, in the order they were added. `None` if the order is not recorded.
    order: Option<Vec<u16>>,
}

impl ColorLayer {
    /// Clears the layer, and prepares a list for each batch of each part.
    pub(super) fn begin(&mut self, batches: usize, parts: usize) {
        (self.batches, self.parts) = (batches, parts);
        let count = batches * parts;
        self.lists.resize_with(self.lists.len().max(count), Vec::new);
        self.lists[..count].iter_mut().for_each(Vec::clear);
        if let Some(order) = &mut self.order {
            order.clear();
        }
    }

    /// As [`begin`](Self::begin) with one part, and also records the order of items over all batches.
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

    /// The number of batches.
    pub(super) fn batches(&self) -> usize {
        self.batches
    }

    /// The number of parts.
    pub(super) fn parts(&self) -> usize {
        self.parts
    }

    /// The batch of each item, in the order they were added.
    pub(super) fn order(&self) -> &[u16] {
        self.order.as_deref().unwrap_or_default()
    }
}

/// Inputs for sorting constraints.
pub(super) struct Sorter<'a> {
    pub(super) input: &'a RowInput<'a>,
    /// As in [`BodyRows`](super::BodyRows).
    pub(super) axes: &'a [Vector],
    pub(super) partition: &'a Partition,
}

impl Sorter<'_> {
    /// Whether one of two bodies has an inverse mass per axis.
    #[inline(always)]
    pub(super) fn is_held(&self, bodies: [u32; 2]) -> bool {
        let held = |body: u32| self.axes[self.input.row_of(body) as usize] != Vector::ONE;
        !self.axes.is_empty() && bodies.into_iter().any(held)
    }

    /// The part that a constraint between two bodies belongs to.
    #[inline(always)]
    pub(super) fn part(&self, id: u32, bodies: [u32; 2], parts: usize) -> usize {
        if parts == 1 {
            0
        } else {
            self.partition.part(bodies.map(|body| self.input.row_of(body)), id, parts)
        }
    }
}
