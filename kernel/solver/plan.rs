//! The solve order: stages, cut into blocks that workers share.

use super::batch::SolverPasses;
use super::color_layer::ColorLayer;
use super::input::Item;
use super::partition::Partition;

/// Consecutive rows of one batch. Blocks of a stage have no dynamic body in common, so they may be solved
/// in any order or in parallel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    pub(super) batch: u16,
    /// The passes that the rows need.
    pub(super) passes: SolverPasses,
    start: u32,
    len: u32,
    /// Index of the list of the plan that holds the block's items.
    list: u32,
    first_item: u32,
    items: u32,
}

impl Block {
    /// The rows in the batch.
    #[inline(always)]
    pub(super) fn rows(&self) -> core::ops::Range<usize> {
        self.start as usize..(self.start + self.len) as usize
    }
}

/// Location of a list of items: colour, layer, part and batch.
#[derive(Clone, Copy, Debug)]
struct ListPlace {
    color: u8,
    layer: u32,
    part: u32,
    batch: u32,
}

/// The order in which blocks are solved.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    pub(super) blocks: Vec<Block>,
    /// For each stage, the end of its blocks in `blocks`, and whether workers share the stage.
    ends: Vec<(u32, bool)>,
    /// For each stage and worker, the end of the worker's blocks within the stage.
    parts: Vec<u32>,
    lists: Vec<ListPlace>,
    /// Number of rows of each batch.
    rows: Vec<u32>,
    workers: usize,
    /// Maximum number of rows of a block.
    block_rows: u32,
    /// The next item of each batch, while items are planned one per row.
    next: Vec<u32>,
    /// Number of items of each batch that have a place in a row.
    items: Vec<u32>,
}

/// Blocks that may be solved in any order or in parallel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage<'a> {
    pub(super) blocks: &'a [Block],
    /// The end of each worker's blocks; `None` if the stage is not shared.
    pub(super) parts: Option<&'a [u32]>,
}

/// The layer being planned, and the batches of its lists.
pub(super) struct Planned<'a> {
    pub(super) color: u8,
    pub(super) number: u32,
    pub(super) layer: &'a ColorLayer,
    /// The batch of the layer's first list.
    pub(super) first_batch: usize,
    /// Number of lanes of a row.
    pub(super) width: u32,
}

impl Plan {
    /// Clears the plan. New blocks have at most `block_rows` rows, and shared stages have one range of
    /// blocks per worker.
    pub(super) fn begin(&mut self, block_rows: u32, workers: usize, batches: usize) {
        self.blocks.clear();
        self.ends.clear();
        self.parts.clear();
        self.lists.clear();
        self.rows.clear();
        self.rows.resize(batches, 0);
        self.workers = workers;
        self.block_rows = block_rows;
        self.items.clear();
        self.items.resize(batches, 0);
    }

    /// Plans one stage from a layer.
    pub(super) fn add(&mut self, planned: &Planned, partition: &Partition) {
        let parts = planned.layer.parts();
        debug_assert!((1..=partition.workers()).contains(&parts), "{parts} parts");
        for worker in 0..partition.workers() {
            if let Some(part) = partition.of_worker(worker, parts) {
                for batch in 0..planned.layer.batches() {
                    self.add_list(planned, part, batch);
                }
            }
            self.end_part();
        }
        self.end_stage(parts > 1);
    }

    /// Plans the items of a layer in the order they were added, one per row. Consecutive items of a batch
    /// form one stage, which workers do not share.
    pub(super) fn add_singly(&mut self, planned: &Planned) {
        let layer = planned.layer;
        let mut next = core::mem::take(&mut self.next);
        next.clear();
        next.resize(layer.batches(), 0);
        let first_list = self.lists.len() as u32;
        for batch in 0..layer.batches() as u32 {
            let Planned { color, number, .. } = *planned;
            self.lists.push(ListPlace { color, layer: number, part: 0, batch });
        }
        for run in layer.order().chunk_by(|a, b| a == b) {
            let (list, batch, items) =
                (first_list + u32::from(run[0]), usize::from(run[0]), run.len() as u32);
            self.add_block(planned.first_batch + batch, list, next[batch], items, 1);
            next[batch] += items;
            (0..self.workers).for_each(|_| self.end_part());
            self.end_stage(false);
        }
        self.next = next;
    }

    /// Cuts the rows of a list into blocks of the current stage.
    fn add_list(&mut self, planned: &Planned, part: usize, batch: usize) {
        debug_assert!(self.block_rows > 0, "a plan is begun before it is added to");
        let all = planned.layer.list(part, batch).len() as u32;
        if all == 0 {
            return;
        }
        let list = self.lists.len() as u32;
        let Planned { color, number, width, .. } = *planned;
        self.lists.push(ListPlace { color, layer: number, part: part as u32, batch: batch as u32 });
        let (most, mut first) = (self.block_rows.saturating_mul(width), 0);
        while first < all {
            let items = most.min(all - first);
            self.add_block(planned.first_batch + batch, list, first, items, width);
            first += items;
        }
    }

    /// Adds a block of items of a list.
    fn add_block(&mut self, batch: usize, list: u32, first_item: u32, items: u32, width: u32) {
        let (start, len) = (self.rows[batch], items.div_ceil(width));
        let (batch, passes) = (batch as u16, SolverPasses::BASIC);
        self.blocks.push(Block { batch, passes, start, len, list, first_item, items });
        self.rows[usize::from(batch)] += len;
        self.items[usize::from(batch)] += items;
    }

    /// Ends a worker's range of blocks in the current stage.
    fn end_part(&mut self) {
        self.parts.push(self.blocks.len() as u32 - self.start());
    }

    /// Ends the current stage. Later stages wait for it.
    fn end_stage(&mut self, is_shared: bool) {
        let end = self.blocks.len() as u32;
        debug_assert_eq!(self.parts.len(), (self.ends.len() + 1) * self.workers, "each worker has a part");
        if self.start() < end {
            self.ends.push((end, is_shared));
        }
        self.parts.truncate(self.ends.len() * self.workers);
    }

    /// The first block of the current stage.
    fn start(&self) -> u32 {
        self.ends.last().map_or(0, |(end, _)| *end)
    }

    /// Number of rows of each batch.
    pub(super) fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// Number of items of each batch.
    pub(super) fn item_counts(&self) -> &[u32] {
        &self.items
    }

    /// The items of a block.
    #[inline(always)]
    pub(super) fn items<'a>(&self, block: &Block, layers: &'a [Vec<ColorLayer>]) -> &'a [Item] {
        let ListPlace { color, layer, part, batch } = self.lists[block.list as usize];
        let list = layers[usize::from(color)][layer as usize].list(part as usize, batch as usize);
        &list[block.first_item as usize..(block.first_item + block.items) as usize]
    }

    /// The stages in their order.
    pub(super) fn stages(&self) -> impl Iterator<Item = Stage<'_>> {
        let mut start = 0;
        self.ends.iter().zip(self.parts.chunks(self.workers.max(1))).map(move |(&(end, is_shared), parts)| {
            let blocks = &self.blocks[start..end as usize];
            start = end as usize;
            Stage { blocks, parts: is_shared.then_some(parts) }
        })
    }
}
