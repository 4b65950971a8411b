//! Rows of joints in batches: one for each size of block and number of single coordinates.
#![expect(unsafe_code, reason = "blocks of one stage are changed at once")]

use super::super::batch::{Batch, Filling, Pass, Passes, Sweep};
use super::super::input::Item;
use super::super::layer::{Layer, Sorter};
use super::super::{BodyRow, MassRow, RowView, SubstepParams};
use super::def::JointDef;
use super::dim::{AXES, BLOCK};
use super::row::{Hold, Row};
use super::single::Single;
use super::table::{JointTable, Records};
use super::tree::JointTrees;
use crate::contact::ManifoldsView;
use crate::data::Parts;
use crate::graph::{ColorGraph, ConstraintKind};
use crate::math::{DIM, Entry, Job, Lane};
use core::ops::Range;

const KIND: ConstraintKind = ConstraintKind::Joint;

/// Number of batches of joints in one width.
pub(in super::super) const JOINT_BATCHES: usize = CLASSES.len();

/// The size of the block and the number of single coordinates that the joints of a batch have room for.
#[derive(Clone, Copy, Debug)]
struct Class {
    block: usize,
    singles: usize,
}

/// The class of each batch. A joint is in the first that it fits in.
const CLASSES: [Class; 6] = [
    Class { block: DIM, singles: 0 },
    Class { block: 0, singles: 1 },
    Class { block: DIM, singles: 2 },
    Class { block: BLOCK, singles: 0 },
    Class { block: BLOCK, singles: 1 },
    Class { block: BLOCK, singles: AXES },
];

/// The batch of a joint.
fn class_of(def: &JointDef) -> usize {
    let block = (0..BLOCK).rev().find(|k| def.is_in_block(*k)).map_or(0, |last| last + 1);
    let singles = (0..AXES).filter(|k| def.is_single(*k)).count();
    let fits = |class: &Class| class.block >= block && class.singles >= singles;
    CLASSES.iter().position(fits).expect("the last one has room for all")
}

/// The joints of a colour.
pub(in super::super) fn joints(colors: &ColorGraph, color: u8) -> &[u32] {
    colors.constraints(KIND, color)
}

/// Sorts joints into a layer, from batch `first` on. Those of trees are left out.
pub(in super::super) fn sort_joints(
    joints: &[u32],
    first: usize,
    (table, trees): (&JointTable, &JointTrees),
    sorter: &Sorter,
    layer: &mut Layer,
) {
    let parts = layer.parts();
    for &id in joints.iter().filter(|id| !trees.holds(**id)) {
        let bodies = sorter.input.bodies.constraints(KIND).get(id).bodies;
        let batch = first + class_of(&table.record(id).def);
        layer.push(sorter.part(id, bodies, parts), batch, Item { id, index: 0 });
    }
}

/// The rows of one width, by class. The last ones may be unused.
#[derive(Clone, Debug)]
pub(in super::super) struct JointRows<N: Lane>([ClassRows<N>; JOINT_BATCHES]);

#[derive(Clone, Debug)]
struct ClassRows<N: Lane> {
    rows: Vec<Row<N>>,
    /// For each row as many as its class has.
    singles: Vec<Single<N>>,
}

impl<N: Lane> Default for JointRows<N> {
    fn default() -> Self {
        Self(core::array::from_fn(|_| ClassRows { rows: Vec::new(), singles: Vec::new() }))
    }
}

impl<N: Entry> JointRows<N> {
    /// Resizes the rows of each batch. Their content is stale.
    pub(in super::super) fn make_room(&mut self, rows: &[u32]) {
        for ((class, of), count) in self.0.iter_mut().zip(CLASSES).zip(rows) {
            let count = *count as usize;
            if class.rows.len() < count {
                class.rows.resize(count, Row::default());
                class.singles.resize(count * of.singles, Single::NONE);
            }
        }
    }

    pub(in super::super) fn view<'a>(
        &'a mut self,
        proof: N::Proof,
        records: &'a Records<'a>,
    ) -> [JointView<'a, N>; JOINT_BATCHES] {
        let mut classes = CLASSES.into_iter();
        self.0.each_mut().map(|rows| JointView {
            proof,
            class: classes.next().expect("as many classes as batches"),
            rows: Parts::of(&mut rows.rows),
            singles: Parts::of(&mut rows.singles),
            records,
        })
    }
}

/// A view of the rows of one class whose blocks are changed by several threads.
pub(in super::super) struct JointView<'a, N: Entry> {
    proof: N::Proof,
    class: Class,
    rows: Parts<'a, Row<N>>,
    singles: Parts<'a, Single<N>>,
    records: &'a Records<'a>,
}

impl<'a, N: Entry> JointView<'a, N> {
    /// The rows of a range, and their single coordinates.
    ///
    /// # Safety
    /// While the rows are in use, no range that overlaps theirs may be taken.
    unsafe fn take(&self, rows: Range<usize>) -> (&'a mut [Row<N>], &'a mut [Single<N>]) {
        let count = self.class.singles;
        // SAFETY: by the contract.
        unsafe { (self.rows.take(rows.clone()), self.singles.take(rows.start * count..rows.end * count)) }
    }
}

impl<N: Entry> Batch for JointView<'_, N> {
    unsafe fn fill(&self, rows: Range<usize>, items: &[Item], from: &Filling) -> Passes {
        let constraints = from.input.bodies.constraints(KIND);
        let count = self.class.singles;
        // SAFETY: by the contract.
        let (rows, singles) = unsafe { self.take(rows) };
        singles.fill(Single::NONE);
        for (i, (row, lanes)) in rows.iter_mut().zip(items.chunks(N::WIDTH)).enumerate() {
            *row = Row::default();
            for (lane, item) in lanes.iter().enumerate() {
                // SAFETY: a joint is in one row, so by the contract no other thread has its record.
                let record = unsafe { self.records.0.one(item.id as usize) };
                let singles = &mut singles[i * count..(i + 1) * count];
                row.set(singles, (lane, Hold::Row), record, constraints.get(item.id).bodies, from);
            }
        }
        // SAFETY: the job has no further condition.
        unsafe { N::enter(self.proof, FinishJob { rows, masses: from.masses }) };
        Passes::BASIC
    }

    unsafe fn run(&self, rows: Range<usize>, _: Passes, sweep: &Sweep) {
        // SAFETY: by the contract.
        unsafe {
            let (rows, singles) = self.take(rows);
            let Sweep { bodies, params, pass } = *sweep;
            N::enter(self.proof, RunJob { class: self.class, rows, singles, bodies, params, pass });
        }
    }

    unsafe fn store(&self, rows: Range<usize>, items: &[Item], _: &ManifoldsView) {
        let count = self.class.singles;
        // SAFETY: by the contract.
        let (rows, singles) = unsafe { self.take(rows) };
        for (i, (row, lanes)) in rows.iter().zip(items.chunks(N::WIDTH)).enumerate() {
            for (lane, item) in lanes.iter().enumerate() {
                // SAFETY: a joint is in one row, so by the contract no other thread has its record.
                let record = unsafe { self.records.0.one(item.id as usize) };
                row.store(&singles[i * count..(i + 1) * count], lane, record);
            }
        }
    }
}

struct FinishJob<'a, N: Lane> {
    rows: &'a mut [Row<N>],
    masses: &'a [MassRow],
}

impl<N: Lane> Job for FinishJob<'_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        for row in self.rows.iter_mut() {
            row.finish(self.masses);
        }
    }
}

struct RunJob<'a, N: Lane> {
    class: Class,
    rows: &'a mut [Row<N>],
    singles: &'a mut [Single<N>],
    bodies: RowView<'a, BodyRow>,
    params: &'a SubstepParams,
    pass: Pass,
}

impl<N: Lane> Job for RunJob<'_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        // SAFETY: by the contract.
        unsafe {
            match self.class.block {
                0 => self.pass::<0>(),
                DIM => self.pass::<DIM>(),
                _ => self.pass::<BLOCK>(),
            }
        }
    }
}

impl<N: Lane> RunJob<'_, N> {
    /// # Safety
    /// As [`Batch::run`].
    #[inline(always)]
    unsafe fn pass<const D: usize>(self) {
        let count = self.class.singles;
        for (i, row) in self.rows.iter_mut().enumerate() {
            let singles = &mut self.singles[i * count..(i + 1) * count];
            // SAFETY: by the contract.
            unsafe { row.run::<D>(singles, &self.bodies, self.params, self.pass) };
        }
    }
}
