//! Contact rows in memory: arrays by point count, cut into blocks that are solved stage by stage.
#![expect(unsafe_code, reason = "blocks of one stage are changed at once")]

use super::{ContactRow, DeepRow, InvMass, RestitutionRow};
use crate::data::Parts;
use crate::math::Lane;
use core::ops::Range;

/// Rows are laid out by the number of points they have room for: 1, 2 or 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointClass {
    /// One point.
    One,
    /// Two points.
    Two,
    /// Three or four points.
    Four,
}

impl PointClass {
    /// All classes, in the order in which a colour's rows are laid out.
    pub const ALL: [Self; 3] = [Self::Four, Self::Two, Self::One];

    /// The smallest class with room for `count` points.
    pub fn of(count: u32) -> Self {
        match count {
            0 | 1 => Self::One,
            2 => Self::Two,
            _ => Self::Four,
        }
    }
}

/// Which of the solver's sets of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Set {
    Overflow,
    OverflowHeld,
    Wide,
    WideHeld,
}

/// Consecutive rows of one class in one set. The dynamic bodies of all blocks of a stage are different, so
/// that they may be solved in any order or at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    pub(super) set: Set,
    pub(super) class: PointClass,
    pub(super) start: u32,
    pub(super) len: u32,
    /// Whether any of them can bounce.
    pub(super) bouncy: bool,
    /// Whether any of them overlaps deeply.
    pub(super) deep: bool,
}

/// The order in which blocks are solved.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    pub(super) blocks: Vec<Block>,
    /// Where each stage ends among the blocks, and whether it is shared, ...
    ends: Vec<(u32, bool)>,
    /// ... and where within it each member's part does.
    parts: Vec<u32>,
    members: usize,
    /// How many rows a block may have.
    block_rows: u32,
    /// How many manifolds have a place in a row.
    pub(super) manifolds: usize,
}

/// Blocks that may be solved in any order or at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stage<'a> {
    pub(super) blocks: &'a [Block],
    /// Where each member's part of them ends; `None` if there are too few to share.
    pub(super) parts: Option<&'a [u32]>,
}

impl Plan {
    /// Forgets everything. From now on blocks have up to so many rows, and stages so many parts.
    pub(super) fn begin(&mut self, block_rows: u32, members: usize) {
        self.blocks.clear();
        self.ends.clear();
        self.parts.clear();
        self.members = members;
        self.block_rows = block_rows;
        self.manifolds = 0;
    }

    /// Cuts the rows of so many manifolds into blocks of the stage that is being planned.
    pub(super) fn add(&mut self, set: Set, class: PointClass, rows: Range<u32>, manifolds: usize) {
        debug_assert!(self.block_rows > 0, "a plan is begun before it is added to");
        debug_assert!(rows.len() <= manifolds, "{manifolds} manifolds in {rows:?}: no row is empty");
        self.manifolds += manifolds;
        let mut start = rows.start;
        while start < rows.end {
            let len = self.block_rows.min(rows.end - start);
            self.blocks.push(Block { set, class, start, len, bouncy: false, deep: false });
            start += len;
        }
    }

    /// Ends a member's part of the stage that is being planned.
    pub(super) fn end_part(&mut self) {
        self.parts.push(self.blocks.len() as u32 - self.start());
    }

    /// Ends a stage, which is shared or not: what is added from now on waits for what was added before.
    pub(super) fn end_stage(&mut self, is_shared: bool) {
        let end = self.blocks.len() as u32;
        debug_assert_eq!(self.parts.len(), (self.ends.len() + 1) * self.members, "each member has a part");
        if self.start() < end {
            self.ends.push((end, is_shared));
        }
        self.parts.truncate(self.ends.len() * self.members);
    }

    /// Where the stage that is being planned begins.
    fn start(&self) -> u32 {
        self.ends.last().map_or(0, |(end, _)| *end)
    }

    /// How many rows there are.
    pub(super) fn rows(&self) -> u32 {
        self.blocks.iter().map(|block| block.len).sum()
    }

    /// The stages in their order.
    pub(super) fn stages(&self) -> impl Iterator<Item = Stage<'_>> {
        let mut start = 0;
        self.ends.iter().zip(self.parts.chunks(self.members.max(1))).map(move |(&(end, is_shared), parts)| {
            let blocks = &self.blocks[start..end as usize];
            start = end as usize;
            Stage { blocks, parts: is_shared.then_some(parts) }
        })
    }
}

/// Where a lane's manifold comes from and its impulses go back to.
#[derive(Clone, Copy, Debug)]
pub struct Source<N: Lane> {
    /// The contact of each lane; [`NONE`](crate::table::NONE) for padding.
    pub contacts: N::Ids,
    /// Which of the contact's manifolds.
    pub manifolds: N::Ids,
}

/// The rows of one class.
#[derive(Clone, Debug)]
pub struct Rows<N: Lane, M, const P: usize> {
    /// What every pass sweeps. Here and in the next two there may be more than are in use.
    pub rows: Vec<ContactRow<N, M, P>>,
    /// What the restitution pass needs besides.
    pub bounces: Vec<RestitutionRow<N, P>>,
    /// What deep overlap needs besides.
    pub deeps: Vec<DeepRow<N, P>>,
    /// Where the rows come from: one for each that is in use.
    pub sources: Vec<Source<N>>,
}

impl<N: Lane, M, const P: usize> Default for Rows<N, M, P> {
    fn default() -> Self {
        Self { rows: Vec::new(), bounces: Vec::new(), deeps: Vec::new(), sources: Vec::new() }
    }
}

impl<N: Lane, M: InvMass<N>, const P: usize> Rows<N, M, P> {
    /// Makes room for as many rows as there are sources. What they hold is old.
    fn make_room(&mut self, any_deep: bool) {
        let count = self.sources.len();
        if self.rows.len() < count {
            self.rows.resize(count, ContactRow::default());
            self.bounces.resize(count, RestitutionRow::default());
        }
        if any_deep && self.deeps.len() < count {
            self.deeps.resize(count, DeepRow::default());
        }
    }

    fn view(&mut self) -> RowsView<'_, N, M, P> {
        RowsView {
            rows: Parts::of(&mut self.rows),
            bounces: Parts::of(&mut self.bounces),
            deeps: Parts::of(&mut self.deeps),
            sources: &self.sources,
        }
    }
}

/// The contact rows of a step for one lane width and kind of inverse mass.
#[derive(Clone, Debug)]
pub struct RowSet<N: Lane, M> {
    /// Manifolds of one point.
    pub one: Rows<N, M, 1>,
    /// Manifolds of two points.
    pub two: Rows<N, M, 2>,
    /// Manifolds of three or four points.
    pub four: Rows<N, M, 4>,
}

impl<N: Lane, M: InvMass<N>> Default for RowSet<N, M> {
    fn default() -> Self {
        Self { one: Rows::default(), two: Rows::default(), four: Rows::default() }
    }
}

impl<N: Lane, M: InvMass<N>> RowSet<N, M> {
    /// Forgets all rows; keeps the memory.
    pub fn clear(&mut self) {
        self.one.sources.clear();
        self.two.sources.clear();
        self.four.sources.clear();
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.one.sources.len() + self.two.sources.len() + self.four.sources.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn make_room(&mut self, any_deep: bool) {
        self.one.make_room(any_deep);
        self.two.make_room(any_deep);
        self.four.make_room(any_deep);
    }

    pub(super) fn view(&mut self) -> RowSetView<'_, N, M> {
        RowSetView { one: self.one.view(), two: self.two.view(), four: self.four.view() }
    }
}

/// [`Rows`], changed block by block.
pub(super) struct RowsView<'a, N: Lane, M, const P: usize> {
    rows: Parts<'a, ContactRow<N, M, P>>,
    bounces: Parts<'a, RestitutionRow<N, P>>,
    deeps: Parts<'a, DeepRow<N, P>>,
    sources: &'a [Source<N>],
}

/// The rows of one block.
pub(super) struct BlockRows<'a, N: Lane, M, const P: usize> {
    pub(super) rows: &'a mut [ContactRow<N, M, P>],
    pub(super) bounces: &'a mut [RestitutionRow<N, P>],
    /// Empty in steps without deep overlap.
    pub(super) deeps: &'a mut [DeepRow<N, P>],
    pub(super) sources: &'a [Source<N>],
}

impl<'a, N: Lane, M, const P: usize> RowsView<'a, N, M, P> {
    /// # Safety
    /// While the block is in use nobody may take one that overlaps it.
    #[inline(always)]
    pub(super) unsafe fn take(&self, block: &Block) -> BlockRows<'a, N, M, P> {
        let range = block.start as usize..(block.start + block.len) as usize;
        debug_assert!(!range.is_empty() && range.end <= self.sources.len(), "block {block:?} has rows");
        let deeps = if self.deeps.len() < range.end { 0..0 } else { range.clone() };
        // SAFETY: by the contract.
        unsafe {
            BlockRows {
                rows: self.rows.take(range.clone()),
                bounces: self.bounces.take(range.clone()),
                deeps: self.deeps.take(deeps),
                sources: &self.sources[range],
            }
        }
    }
}

/// [`RowSet`], changed block by block.
pub(super) struct RowSetView<'a, N: Lane, M> {
    pub(super) one: RowsView<'a, N, M, 1>,
    pub(super) two: RowsView<'a, N, M, 2>,
    pub(super) four: RowsView<'a, N, M, 4>,
}

/// Runs `$body` with `$rows` bound to the array of a class, whatever its number of points.
macro_rules! with_rows {
    ($set:expr, $class:expr, |$rows:ident| $body:expr) => {
        match $class {
            $crate::solver::PointClass::One => {
                let $rows = &mut $set.one;
                $body
            }
            $crate::solver::PointClass::Two => {
                let $rows = &mut $set.two;
                $body
            }
            $crate::solver::PointClass::Four => {
                let $rows = &mut $set.four;
                $body
            }
        }
    };
}
pub(super) use with_rows;

/// Runs `$body` with `$rows` bound to the rows of a block, whatever their number of points. For functions whose contract is
/// [`RowsView::take`]'s.
macro_rules! with_block {
    ($set:expr, $block:expr, |$rows:ident| $body:expr) => {
        match $block.class {
            $crate::solver::PointClass::One => {
                // SAFETY: the caller guarantees that no other thread uses rows of this block.
                let $rows = unsafe { $set.one.take($block) };
                $body
            }
            $crate::solver::PointClass::Two => {
                // SAFETY: as above.
                let $rows = unsafe { $set.two.take($block) };
                $body
            }
            $crate::solver::PointClass::Four => {
                // SAFETY: as above.
                let $rows = unsafe { $set.four.take($block) };
                $body
            }
        }
    };
}
pub(super) use with_block;
