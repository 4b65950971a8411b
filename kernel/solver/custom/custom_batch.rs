//! Rows of custom constraints in a batch. A row has one constraint per lane, run one after the other.
#![expect(unsafe_code, reason = "blocks of one stage are changed at once")]

use super::super::batch::{Batch, Filling, SolverPass, SolverPasses, Sweep};
use super::super::color_layer::{ColorLayer, Sorter};
use super::super::input::Item;
use super::super::{BodyRow, MassRow, RowView};
use super::body::CustomBody;
use super::table::{CustomTable, Records};
use crate::contact::ManifoldsView;
use crate::data::Parts;
use crate::graph::{ColorGraph, ConstraintKind};
use crate::math::Vector;
use crate::table::NONE;
use core::ops::Range;

const KIND: ConstraintKind = ConstraintKind::Custom;

/// Number of batches of custom constraints in one width.
pub(in super::super) const CUSTOM_BATCHES: usize = 1;

/// The custom constraints of a colour.
pub(in super::super) fn customs(colors: &ColorGraph, color: u8) -> &[u32] {
    colors.constraints(KIND, color)
}

/// Sorts constraints into a batch of a layer. Constraints without an implementation, which only connect
/// bodies, are left out.
pub(in super::super) fn sort_customs(
    customs: &[u32],
    batch: usize,
    table: &CustomTable,
    sorter: &Sorter,
    layer: &mut ColorLayer,
) {
    let parts = layer.parts();
    for &id in customs.iter().filter(|id| table.acts(**id)) {
        let bodies = sorter.input.bodies.constraints(KIND).get(id).bodies;
        layer.push(sorter.part(id, bodies, parts), batch, Item { id, index: 0 });
    }
}

/// A constraint of this step.
#[derive(Clone, Copy, Debug)]
struct CustomRow {
    /// The id; [`NONE`] for padding.
    id: u32,
    rows: [u32; 2],
    bodies: [CustomBody; 2],
}

/// The constraints of all rows of one width. The last ones may be unused.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct CustomRows {
    rows: Vec<Option<CustomRow>>,
}

impl CustomRows {
    /// Resizes to a number of rows with `width` lanes. Their content is stale.
    pub(in super::super) fn make_room(&mut self, rows: u32, width: usize) {
        let count = rows as usize * width;
        if self.rows.len() < count {
            self.rows.resize(count, None);
        }
    }

    pub(in super::super) fn view<'a>(&'a mut self, width: usize, records: &'a Records<'a>) -> CustomView<'a> {
        CustomView { rows: Parts::of(&mut self.rows), width, records }
    }
}

/// A view of [`CustomRows`]. Several threads may change its blocks.
pub(in super::super) struct CustomView<'a> {
    rows: Parts<'a, Option<CustomRow>>,
    width: usize,
    records: &'a Records<'a>,
}

impl<'a> CustomView<'a> {
    /// The constraints of a range of rows.
    ///
    /// # Safety
    /// While the constraints are in use, no overlapping range is taken.
    unsafe fn take(&self, rows: Range<usize>) -> &'a mut [Option<CustomRow>] {
        // SAFETY: by the contract.
        unsafe { self.rows.take(rows.start * self.width..rows.end * self.width) }
    }
}

impl Batch for CustomView<'_> {
    unsafe fn fill(&self, rows: Range<usize>, items: &[Item], from: &Filling) -> SolverPasses {
        // SAFETY: by the contract.
        let slots = unsafe { self.take(rows) };
        slots.fill(None);
        for (slot, item) in slots.iter_mut().zip(items) {
            // SAFETY: by the contract, no other thread writes the bodies.
            let row = unsafe { CustomRow::new(item.id, from) };
            // SAFETY: a constraint is in one row, so by the contract no other thread uses its record.
            let record = unsafe { self.records.0.one(item.id as usize) };
            if let Some(act) = &mut record.act {
                let [a, b] = &row.bodies;
                act.prepare([a, b], from.params);
            }
            *slot = Some(row);
        }
        SolverPasses::BASIC
    }

    unsafe fn run(&self, rows: Range<usize>, _: SolverPasses, sweep: &Sweep) {
        // SAFETY: by the contract.
        for row in unsafe { self.take(rows) }.iter_mut().flatten() {
            // SAFETY: a constraint is in one row, so by the contract no other thread uses its record.
            let record = unsafe { self.records.0.one(row.id as usize) };
            let Some(act) = &mut record.act else { continue };
            // SAFETY: by the contract.
            unsafe { row.load(&sweep.bodies) };
            let [a, b] = &mut row.bodies;
            match sweep.pass {
                SolverPass::WarmStart => act.warm_start([a, b], sweep.params),
                SolverPass::Solve => act.solve([a, b], sweep.params, true),
                SolverPass::Relax => act.solve([a, b], sweep.params, false),
                SolverPass::UndoSplit | SolverPass::Measure => continue,
            }
            // SAFETY: by the contract.
            record.is_faulty |= !unsafe { row.save(&sweep.bodies) };
        }
    }

    unsafe fn store(&self, rows: Range<usize>, items: &[Item], _: &ManifoldsView) {
        debug_assert!(rows.len() * self.width >= items.len(), "each item has a place");
        for item in items {
            // SAFETY: a constraint is in one row, so by the contract no other thread uses its record.
            let record = unsafe { self.records.0.one(item.id as usize) };
            if let Some(act) = &mut record.act {
                act.store();
            }
        }
    }
}

impl CustomRow {
    /// # Safety
    /// Until the call returns, no other thread writes a body of the constraint.
    unsafe fn new(id: u32, from: &Filling) -> Self {
        let input = from.input;
        let ids = input.bodies.constraints(KIND).get(id).bodies;
        let rows = ids.map(|body| input.row_of(body));
        let bodies = [0, 1].map(|side| {
            let (row, body) = (rows[side] as usize, ids[side]);
            debug_assert!(body != NONE, "a constraint has two bodies");
            let pose = &input.bodies.poses[body as usize];
            let mass: &MassRow = &from.masses[row];
            let axes = from.axes.get(row).copied().unwrap_or(Vector::ONE);
            // SAFETY: by the contract; the reference does not outlive the copy.
            let motion = unsafe { *from.bodies.get(rows[side]) };
            let ((linear, angular), (shift, turn)) = (motion.velocity(), motion.delta());
            let is_dynamic = rows[side] >= from.first_dynamic;
            CustomBody {
                linear,
                angular,
                shift,
                turn,
                center: pose.center,
                rotation: pose.rotation,
                local_center: input.bodies[body].local_center,
                inv_mass: if is_dynamic { axes * mass.inv_mass() } else { Vector::ZERO },
                inv_inertia: if is_dynamic { mass.inv_inertia() } else { Default::default() },
            }
        });
        Self { id, rows, bodies }
    }

    /// Loads the velocities and displacements of both bodies.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes these rows.
    unsafe fn load(&mut self, view: &RowView<BodyRow>) {
        for (body, row) in self.bodies.iter_mut().zip(self.rows) {
            // SAFETY: by the contract; the reference does not outlive the copy.
            let motion = unsafe { *view.get(row) };
            (body.linear, body.angular) = motion.velocity();
            (body.shift, body.turn) = motion.delta();
        }
    }

    /// Stores the velocities of both bodies if all are finite. Returns whether they are.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the writable rows among these.
    unsafe fn save(&self, view: &RowView<BodyRow>) -> bool {
        if self.bodies.iter().any(|body| !(body.linear.is_finite() && body.angular.is_finite())) {
            return false;
        }
        for (body, row) in self.bodies.iter().zip(self.rows) {
            // SAFETY: by the contract.
            unsafe { view.put(row, |row| row.set_velocity(body.linear, body.angular)) };
        }
        true
    }
}
