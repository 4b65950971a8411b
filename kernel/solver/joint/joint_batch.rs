//! Rows of joints in batches: one batch per size of block and number of single coordinates.
#![expect(unsafe_code, reason = "blocks of one stage are changed at once")]

use super::super::batch::{Batch, Filling, SolverPass, SolverPasses, Sweep};
use super::super::color_layer::{ColorLayer, Sorter};
use super::super::input::Item;
use super::super::{BodyRow, MassRow, RowView, SubstepParams};
use super::class::{CLASSES, COUPLINGS, Class};
use super::coupling_row::{CouplingRow, CouplingView};
use super::dim::BLOCK;
use super::orientation::OrientationRow;
use super::records::Records;
use super::row::{Hold, Row, Stiffness};
use super::single::Single;
use super::table::JointTable;
use super::tree::JointTrees;
use crate::contact::ManifoldsView;
use crate::data::Parts;
use crate::graph::{ColorGraph, ConstraintKind};
use crate::math::{DIM, Entry, Job, Lane};
use core::ops::Range;

const KIND: ConstraintKind = ConstraintKind::Joint;

/// Prefetch distance, in joints.
const PREFETCH_DISTANCE: usize = 3;

/// Number of batches of joints in one width: one for each class, and couplings.
pub(in super::super) const JOINT_BATCHES: usize = COUPLINGS + 1;

/// The joints of a colour.
pub(in super::super) fn joints(colors: &ColorGraph, color: u8) -> &[u32] {
    colors.constraints(KIND, color)
}

/// Sorts joints into a layer, from batch `first` on. Joints of trees are left out.
pub(in super::super) fn sort_joints(
    joints: &[u32],
    first: usize,
    (table, trees): (&JointTable, &JointTrees),
    sorter: &Sorter,
    layer: &mut ColorLayer,
) {
    let parts = layer.parts();
    for &id in joints.iter().filter(|id| !trees.holds(**id)) {
        let bodies = sorter.input.bodies.constraints(KIND).get(id).bodies;
        debug_assert_eq!(bodies, table.bodies(id), "a joint keeps its bodies");
        let batch = first + usize::from(table.summary(id).batch);
        layer.push(sorter.part(id, bodies, parts), batch, Item { id, index: 0 });
    }
}

/// The rows of one width, by class. The last ones may be unused.
#[derive(Clone, Debug)]
pub(in super::super) struct JointRows<N: Lane> {
    classes: [ClassRows<N>; COUPLINGS],
    couplings: Vec<CouplingRow<N>>,
}

#[derive(Clone, Debug)]
struct ClassRows<N: Lane> {
    rows: Vec<Row<N>>,
    /// Single coordinates: for each row, the number of its class.
    singles: Vec<Single<N>>,
    /// One orientation motor per row, if the class has orientation motors.
    turns: Vec<OrientationRow<N>>,
}

impl<N: Lane> Default for JointRows<N> {
    fn default() -> Self {
        let rows = |_| ClassRows { rows: Vec::new(), singles: Vec::new(), turns: Vec::new() };
        Self { classes: core::array::from_fn(rows), couplings: Vec::new() }
    }
}

impl<N: Entry> JointRows<N> {
    /// Resizes the rows of each batch. Their content is stale.
    pub(in super::super) fn make_room(&mut self, rows: &[u32]) {
        for ((class, of), count) in self.classes.iter_mut().zip(CLASSES).zip(rows) {
            let count = *count as usize;
            if class.rows.len() < count {
                class.rows.resize(count, Row::default());
                class.singles.resize(count * of.singles, Single::NONE);
                class.turns.resize(if of.turns { count } else { 0 }, OrientationRow::NONE);
            }
        }
        let count = rows[COUPLINGS] as usize;
        if self.couplings.len() < count {
            self.couplings.resize(count, CouplingRow::default());
        }
    }

    pub(in super::super) fn view<'a>(
        &'a mut self,
        proof: N::Proof,
        records: &'a Records<'a>,
    ) -> JointViews<'a, N> {
        let mut classes = CLASSES.into_iter();
        JointViews {
            classes: self.classes.each_mut().map(|rows| JointView {
                proof,
                class: classes.next().expect("as many classes as batches"),
                rows: Parts::of(&mut rows.rows),
                singles: Parts::of(&mut rows.singles),
                turns: Parts::of(&mut rows.turns),
                records,
            }),
            couplings: CouplingView { proof, rows: Parts::of(&mut self.couplings), records },
        }
    }
}

/// Views of all batches.
pub(in super::super) struct JointViews<'a, N: Entry> {
    classes: [JointView<'a, N>; COUPLINGS],
    couplings: CouplingView<'a, N>,
}

impl<N: Entry> JointViews<'_, N> {
    /// A batch by its number among the batches of joints.
    pub(in super::super) fn batch(&self, number: usize) -> &dyn Batch {
        if number == COUPLINGS { &self.couplings } else { &self.classes[number] }
    }
}

/// A view of the rows of one class. Several threads may change its blocks.
struct JointView<'a, N: Entry> {
    proof: N::Proof,
    class: Class,
    rows: Parts<'a, Row<N>>,
    singles: Parts<'a, Single<N>>,
    turns: Parts<'a, OrientationRow<N>>,
    records: &'a Records<'a>,
}

/// Rows of a class.
struct Taken<'a, N: Lane> {
    class: Class,
    rows: &'a mut [Row<N>],
    singles: &'a mut [Single<N>],
    turns: &'a mut [OrientationRow<N>],
}

impl<N: Lane> Taken<'_, N> {
    /// Each row with its single coordinates and its orientation motor.
    #[inline(always)]
    #[expect(clippy::type_complexity, reason = "it is taken apart at once")]
    fn each(
        &mut self,
    ) -> impl Iterator<Item = (&mut Row<N>, (&mut [Single<N>], Option<&mut OrientationRow<N>>))> {
        let count = self.class.singles;
        let (mut singles, mut turns) = (&mut *self.singles, self.turns.iter_mut());
        self.rows.iter_mut().map(move |row| {
            let (of_row, others) = core::mem::take(&mut singles).split_at_mut(count);
            singles = others;
            (row, (of_row, turns.next()))
        })
    }
}

impl<'a, N: Entry> JointView<'a, N> {
    /// The rows of a range.
    ///
    /// # Safety
    /// While the rows are in use, no overlapping range is taken.
    unsafe fn take(&self, rows: Range<usize>) -> Taken<'a, N> {
        let (class, count) = (self.class, self.class.singles);
        let turns = if class.turns { rows.clone() } else { 0..0 };
        // SAFETY: by the contract.
        unsafe {
            Taken {
                class,
                rows: self.rows.take(rows.clone()),
                singles: self.singles.take(rows.start * count..rows.end * count),
                turns: self.turns.take(turns),
            }
        }
    }
}

impl<N: Entry> Batch for JointView<'_, N> {
    unsafe fn fill(&self, rows: Range<usize>, items: &[Item], from: &Filling) -> SolverPasses {
        // SAFETY: by the contract.
        let mut taken = unsafe { self.take(rows) };
        taken.rows.fill(Row::default());
        taken.singles.fill(Single::NONE);
        taken.turns.fill(OrientationRow::NONE);
        let stiffness = &Stiffness::new(Hold::Row, from.params.h);
        let mut ahead = items.iter().skip(PREFETCH_DISTANCE);
        for ((row, (singles, mut turns)), lanes) in taken.each().zip(items.chunks(N::WIDTH)) {
            for (lane, item) in lanes.iter().enumerate() {
                ahead.next().into_iter().for_each(|item| self.records.prefetch(item.id));
                // SAFETY: a joint is in one row, so by the contract no other thread uses its state.
                let joint = &unsafe { self.records.joint(item.id) };
                row.set((singles, turns.as_deref_mut()), (lane, stiffness), joint, from);
            }
        }
        // SAFETY: the job has no further condition.
        unsafe { N::enter(self.proof, FinishJob { rows: taken.rows, masses: from.masses }) };
        SolverPasses::BASIC
    }

    unsafe fn run(&self, rows: Range<usize>, _: SolverPasses, sweep: &Sweep) {
        // SAFETY: by the contract.
        unsafe {
            let Sweep { bodies, params, pass, .. } = *sweep;
            N::enter(self.proof, RunJob { taken: self.take(rows), bodies, params, pass });
        }
    }

    unsafe fn store(&self, rows: Range<usize>, items: &[Item], _: &ManifoldsView) {
        // SAFETY: by the contract.
        let mut taken = unsafe { self.take(rows) };
        let mut ahead = items.iter().skip(PREFETCH_DISTANCE);
        for ((row, (singles, turns)), lanes) in taken.each().zip(items.chunks(N::WIDTH)) {
            for (lane, item) in lanes.iter().enumerate() {
                ahead.next().into_iter().for_each(|item| self.records.prefetch_state(item.id));
                // SAFETY: a joint is in one row, so by the contract no other thread uses its state.
                let joint = &mut unsafe { self.records.joint(item.id) };
                row.store((singles, turns.as_deref()), lane, joint);
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
    taken: Taken<'a, N>,
    bodies: RowView<'a, BodyRow>,
    params: &'a SubstepParams,
    pass: SolverPass,
}

impl<N: Lane> Job for RunJob<'_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        // SAFETY: by the contract.
        unsafe {
            match self.taken.class.block {
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
    unsafe fn pass<const D: usize>(mut self) {
        for (row, more) in self.taken.each() {
            // SAFETY: by the contract.
            unsafe { row.run::<D>(more, &self.bodies, self.params, self.pass) };
        }
    }
}
