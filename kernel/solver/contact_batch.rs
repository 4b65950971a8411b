//! Contact rows as batches: one batch per lane width, number of points and kind of inverse mass.
#![expect(unsafe_code, reason = "blocks of one stage are changed at once")]

use super::batch::{Batch, Filling, Seek, SolverPass, SolverPasses, Sweep};
use super::blow::Blows;
use super::color_layer::{ColorLayer, Sorter};
use super::contact_fill::{BlockRows, PREFETCH_DISTANCE, fill_rows};
use super::input::Item;
use super::struck::{Striking, Struck};
use super::{BodyRow, ContactRow, GainRow, ImpactRow, InvMass, RowView, SplitImpulseRow, SubstepParams};
use crate::contact::{Manifold, ManifoldsView};
use crate::data::Parts;
use crate::math::{Entry, Ids, Job, Lane, NormalMoment, TangentFrame, Vector};
use core::marker::PhantomData;
use core::ops::Range;

/// The rows of one width.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactRows<N: Lane> {
    held: ByPoints<N, Vector<N>>,
    free: ByPoints<N, N>,
}

/// The rows with one kind of inverse mass, by their maximum number of points.
#[derive(Clone, Debug)]
struct ByPoints<N: Lane, M> {
    four: Rows<N, M, 4>,
    two: Rows<N, M, 2>,
    one: Rows<N, M, 1>,
}

/// The rows of one batch. The last ones may be unused.
#[derive(Clone, Debug)]
struct Rows<N: Lane, M, const P: usize> {
    /// Data of every pass.
    rows: Vec<ContactRow<N, M, P>>,
    /// Data of impacts.
    impacts: Vec<ImpactRow<N>>,
    /// Data of split impulses.
    splits: Vec<SplitImpulseRow<N, P>>,
    /// Sums of impulses over the substeps. Empty if sums are not kept.
    sums: Vec<[N; P]>,
}

impl<N: Lane, M: InvMass<N>> Default for ByPoints<N, M> {
    fn default() -> Self {
        Self { four: Rows::default(), two: Rows::default(), one: Rows::default() }
    }
}

impl<N: Lane, M, const P: usize> Default for Rows<N, M, P> {
    fn default() -> Self {
        Self { rows: Vec::new(), impacts: Vec::new(), splits: Vec::new(), sums: Vec::new() }
    }
}

/// Optional data of the rows of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// Whether rows have split impulses, because a body overlaps another deeply.
    pub(super) any_deep: bool,
    /// Whether sums of impulses are kept.
    pub(super) sums: bool,
}

/// Number of batches of contacts in one width.
pub(super) const CONTACT_BATCHES: usize = 6;

/// The batch of a manifold. Batches of bodies with locked axes come first; within both groups, more points
/// come first.
#[inline(always)]
fn batch_of(is_held: bool, points: u32) -> usize {
    let by_points = match points {
        0 | 1 => 2,
        2 => 1,
        _ => 0,
    };
    if is_held { by_points } else { 3 + by_points }
}

/// Sorts the manifolds with number `index` of some contacts into a layer. Returns the number of contacts
/// with further manifolds.
pub(super) fn sort_contacts(contacts: &[u32], index: u32, sorter: &Sorter, layer: &mut ColorLayer) -> usize {
    let table = sorter.input.contacts;
    let (parts, mut more) = (layer.parts(), 0);
    for &id in contacts {
        let points = match table.point_count(id).of_only_manifold() {
            Some(points) if index == 0 => points,
            Some(_) => 0,
            None => {
                let contact = table.get(id);
                more += usize::from(u32::from(contact.extra_count) > index);
                table.manifold(contact, index).map_or(0, Manifold::solved_points)
            }
        };
        if points > 0 {
            let bodies = table.bodies_of(id);
            let batch = batch_of(sorter.is_held(bodies), points);
            layer.push(sorter.part(id, bodies, parts), batch, Item { id, index });
        }
    }
    more
}

impl<N: Entry> ContactRows<N> {
    /// Resizes the rows of each batch. Their content is stale.
    pub(super) fn make_room(&mut self, rows: &[u32], room: Room) {
        let Self { held, free } = self;
        let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|batch| rows[batch] as usize);
        held.make_room([a, b, c], room);
        free.make_room([d, e, f], room);
    }

    pub(super) fn view(&mut self, proof: N::Proof) -> ContactView<'_, N> {
        ContactView { held: self.held.view(proof), free: self.free.view(proof) }
    }
}

impl<N: Entry, M: InvMass<N>> ByPoints<N, M> {
    fn make_room(&mut self, [four, two, one]: [usize; 3], room: Room) {
        self.four.make_room(four, room);
        self.two.make_room(two, room);
        self.one.make_room(one, room);
    }

    fn view(&mut self, proof: N::Proof) -> ByPointsView<'_, N, M> {
        ByPointsView { four: self.four.view(proof), two: self.two.view(proof), one: self.one.view(proof) }
    }
}

impl<N: Entry, M: InvMass<N>, const P: usize> Rows<N, M, P> {
    fn make_room(&mut self, count: usize, room: Room) {
        if self.rows.len() < count {
            self.rows.resize(count, ContactRow::default());
            self.impacts.resize(count, ImpactRow::default());
        }
        if room.any_deep && self.splits.len() < count {
            self.splits.resize(count, SplitImpulseRow::default());
        }
        if !room.sums {
            self.sums.clear();
        } else if self.sums.len() < count {
            self.sums.resize(count, [N::ZERO; P]);
        }
    }

    fn view(&mut self, proof: N::Proof) -> RowsView<'_, N, M, P> {
        RowsView {
            proof,
            rows: Parts::of(&mut self.rows),
            impacts: Parts::of(&mut self.impacts),
            splits: Parts::of(&mut self.splits),
            sums: Parts::of(&mut self.sums),
        }
    }
}

/// A view of [`ContactRows`]. Several threads may change its blocks.
pub(super) struct ContactView<'a, N: Entry> {
    held: ByPointsView<'a, N, Vector<N>>,
    free: ByPointsView<'a, N, N>,
}

struct ByPointsView<'a, N: Entry, M> {
    four: RowsView<'a, N, M, 4>,
    two: RowsView<'a, N, M, 2>,
    one: RowsView<'a, N, M, 1>,
}

impl<N: Entry> ContactView<'_, N> {
    /// All batches, by number.
    pub(super) fn batches(&self) -> [&dyn Batch; CONTACT_BATCHES] {
        let Self { held, free } = self;
        [&held.four, &held.two, &held.one, &free.four, &free.two, &free.one]
    }
}

/// A view of the rows of one batch. Several threads may change its blocks.
struct RowsView<'a, N: Entry, M, const P: usize> {
    /// Proof that the CPU has the features of the lanes.
    proof: N::Proof,
    rows: Parts<'a, ContactRow<N, M, P>>,
    impacts: Parts<'a, ImpactRow<N>>,
    splits: Parts<'a, SplitImpulseRow<N, P>>,
    sums: Parts<'a, [N; P]>,
}

impl<'a, N: Entry, M: InvMass<N>, const P: usize> RowsView<'a, N, M, P> {
    /// # Safety
    /// While the rows are in use, no other thread takes any of them.
    #[inline(always)]
    unsafe fn take(&self, range: Range<usize>) -> BlockRows<'a, N, M, P> {
        debug_assert!(!range.is_empty() && range.end <= self.rows.len(), "block {range:?} has rows");
        let splits = if self.splits.len() < range.end { 0..0 } else { range.clone() };
        let sums = if self.sums.len() < range.end { 0..0 } else { range.clone() };
        // SAFETY: by the contract.
        unsafe {
            BlockRows {
                rows: self.rows.take(range.clone()),
                impacts: self.impacts.take(range),
                splits: self.splits.take(splits),
                sums: self.sums.take(sums),
            }
        }
    }

    /// Runs a pass over rows, in a function compiled for the CPU features of the lanes.
    ///
    /// # Safety
    /// As [`Batch::run`].
    unsafe fn enter<S: ContactPass>(&self, rows: Range<usize>, passes: SolverPasses, sweep: &Sweep) {
        let Sweep { bodies, gains, params, .. } = *sweep;
        // SAFETY: by the contract.
        unsafe {
            let rows = Swept { block: self.take(rows), passes, bodies, gains, params: *params };
            N::enter(self.proof, RunJob::<S, N, M, P> { rows, pass: PhantomData });
        }
    }
}

impl<N: Entry, M: InvMass<N>, const P: usize> Batch for RowsView<'_, N, M, P> {
    unsafe fn fill(&self, rows: Range<usize>, items: &[Item], from: &Filling) -> SolverPasses {
        // SAFETY: by the contract.
        unsafe { N::enter(self.proof, FillJob { block: self.take(rows), items, from: *from }) }
    }

    unsafe fn run(&self, rows: Range<usize>, passes: SolverPasses, sweep: &Sweep) {
        // SAFETY: by the contract.
        unsafe {
            match sweep.pass {
                SolverPass::WarmStart => self.enter::<WarmStart>(rows, passes, sweep),
                SolverPass::Solve => self.enter::<Solve>(rows, passes, sweep),
                SolverPass::UndoSplit => self.enter::<UndoSplit>(rows, passes, sweep),
                SolverPass::Relax if passes.are_watched() => self.enter::<RelaxWatched>(rows, passes, sweep),
                SolverPass::Relax => self.enter::<Relax>(rows, passes, sweep),
                SolverPass::Measure => self.enter::<Measure>(rows, passes, sweep),
            }
        }
    }

    unsafe fn find_struck(
        &self,
        rows: Range<usize>,
        (items, passes): (&[Item], SolverPasses),
        seek: &Seek,
        found: &mut Vec<Struck>,
    ) -> bool {
        // SAFETY: by the contract.
        unsafe {
            let block = self.take(rows);
            N::enter(self.proof, FindJob { block, items, passes, seek: *seek, found })
        }
    }

    unsafe fn store(&self, rows: Range<usize>, items: &[Item], contacts: &ManifoldsView) {
        // SAFETY: by the contract.
        unsafe { N::enter(self.proof, StoreJob { block: self.take(rows), items, contacts }) }
    }
}

struct FillJob<'a, N: Lane, M, const P: usize> {
    block: BlockRows<'a, N, M, P>,
    items: &'a [Item],
    from: Filling<'a>,
}

impl<N: Lane, M: InvMass<N>, const P: usize> Job for FillJob<'_, N, M, P> {
    type Output = SolverPasses;

    #[inline(always)]
    unsafe fn run(self) -> SolverPasses {
        fill_rows(self.block, self.items, &self.from)
    }
}

/// The operands of a pass.
///
/// Views and parameters are copies. The compiler then knows that they do not alias written rows, and keeps
/// them in registers (8 % less time for sweeps in 2D (m)).
struct Swept<'a, N: Lane, M, const P: usize> {
    block: BlockRows<'a, N, M, P>,
    passes: SolverPasses,
    bodies: RowView<'a, BodyRow>,
    gains: RowView<'a, GainRow>,
    params: SubstepParams,
}

struct RunJob<'a, S, N: Lane, M, const P: usize> {
    rows: Swept<'a, N, M, P>,
    pass: PhantomData<S>,
}

impl<S: ContactPass, N: Lane, M: InvMass<N>, const P: usize> Job for RunJob<'_, S, N, M, P> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        // SAFETY: by the contract.
        unsafe { S::over(self.rows) }
    }
}

/// Whether the rows of a block with these passes have split impulses.
#[inline(always)]
fn has_split(passes: SolverPasses) -> bool {
    passes.has(SolverPass::UndoSplit)
}

/// A pass over the rows of a block.
///
/// The loops are plain, without iterator adaptors: code for a CPU feature must be inlined into the function
/// that enables it.
trait ContactPass {
    /// # Safety
    /// As [`Batch::run`].
    unsafe fn over<N: Lane, M: InvMass<N>, const P: usize>(all: Swept<N, M, P>);
}

struct WarmStart;

impl ContactPass for WarmStart {
    #[inline(always)]
    unsafe fn over<N: Lane, M: InvMass<N>, const P: usize>(all: Swept<N, M, P>) {
        if has_split(all.passes) {
            for (row, split) in all.block.rows.iter_mut().zip(&*all.block.splits) {
                row.scale_impulses(split);
            }
        }
        for row in all.block.rows.iter() {
            // SAFETY: by the contract.
            unsafe { row.warm_start(&all.bodies) };
        }
    }
}

struct Solve;

impl ContactPass for Solve {
    #[inline(always)]
    unsafe fn over<N: Lane, M: InvMass<N>, const P: usize>(all: Swept<N, M, P>) {
        if has_split(all.passes) {
            for (row, split) in all.block.rows.iter().zip(all.block.splits) {
                row.save_impulses(split);
            }
        }
        for row in all.block.rows.iter_mut() {
            // SAFETY: by the contract.
            unsafe { row.solve(&all.bodies, &all.params) };
        }
    }
}

struct Measure;

impl ContactPass for Measure {
    #[inline(always)]
    unsafe fn over<N: Lane, M: InvMass<N>, const P: usize>(all: Swept<N, M, P>) {
        for row in all.block.rows.iter_mut() {
            // SAFETY: by the contract.
            unsafe { row.measure(&all.bodies) };
        }
    }
}

struct UndoSplit;

impl ContactPass for UndoSplit {
    #[inline(always)]
    unsafe fn over<N: Lane, M: InvMass<N>, const P: usize>(all: Swept<N, M, P>) {
        for (row, split) in all.block.rows.iter_mut().zip(&*all.block.splits) {
            // SAFETY: by the contract.
            unsafe { row.undo_split(&all.bodies, split) };
        }
    }
}

struct Relax;

impl ContactPass for Relax {
    #[inline(always)]
    unsafe fn over<N: Lane, M: InvMass<N>, const P: usize>(all: Swept<N, M, P>) {
        for row in all.block.rows.iter_mut() {
            // SAFETY: by the contract.
            unsafe { row.relax(&all.bodies, &all.gains, &all.params, None) };
        }
        for (row, sum) in all.block.rows.iter().zip(all.block.sums) {
            row.sum_impulses(sum);
        }
    }
}

/// [`Relax`] for rows with a point that may be struck.
struct RelaxWatched;

impl ContactPass for RelaxWatched {
    #[inline(always)]
    unsafe fn over<N: Lane, M: InvMass<N>, const P: usize>(all: Swept<N, M, P>) {
        for (row, impact) in all.block.rows.iter_mut().zip(&*all.block.impacts) {
            // SAFETY: by the contract.
            unsafe { row.relax(&all.bodies, &all.gains, &all.params, Some(impact.watched)) };
        }
        for (row, sum) in all.block.rows.iter().zip(all.block.sums) {
            row.sum_impulses(sum);
        }
    }
}

struct FindJob<'a, N: Lane, M, const P: usize> {
    block: BlockRows<'a, N, M, P>,
    items: &'a [Item],
    passes: SolverPasses,
    seek: Seek<'a>,
    found: &'a mut Vec<Struck>,
}

impl<N: Lane, M: InvMass<N>, const P: usize> Job for FindJob<'_, N, M, P> {
    type Output = bool;

    #[inline(always)]
    unsafe fn run(self) -> bool {
        let Self { block, items, passes, seek, found } = self;
        let Striking { bodies, params, time, .. } = seek.striking;
        let mut is_watched = passes.are_watched();
        for (i, (row, impact)) in block.rows.iter().zip(block.impacts).enumerate() {
            if let Some(reached) = seek.reached {
                for ids in &row.ids {
                    let reached = Blows::reached_lanes(reached, ids.lanes());
                    for lane in (0..N::WIDTH).filter(|lane| reached >> lane & 1 != 0) {
                        if impact.watched.get(lane) >= 0.0 {
                            impact.watched.set(lane, 1.0);
                        }
                    }
                }
            }
            let mut lanes = N::bits(N::ZERO.lt(impact.watched));
            if lanes == 0 {
                continue;
            }
            is_watched = true;
            // SAFETY: by the contract.
            lanes = unsafe { row.struck_lanes(lanes, &bodies, params, time) };
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                let (item, restitution) = (items[i * N::WIDTH + lane], impact.restitution.get(lane));
                // SAFETY: by the contract.
                found.push(unsafe { Struck::of(item, row.lane(lane), restitution, &seek.striking) });
            }
        }
        is_watched
    }
}

struct StoreJob<'a, N: Lane, M, const P: usize> {
    block: BlockRows<'a, N, M, P>,
    items: &'a [Item],
    contacts: &'a ManifoldsView<'a>,
}

impl<N: Lane, M: InvMass<N>, const P: usize> Job for StoreJob<'_, N, M, P> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        let Self { block, items, contacts } = self;
        for (i, (row, lanes)) in block.rows.iter().zip(items.chunks(N::WIDTH)).enumerate() {
            let next = (i + PREFETCH_DISTANCE) * N::WIDTH;
            for item in items.iter().skip(next).take(N::WIDTH) {
                contacts.prefetch(&[item.id]);
            }
            let friction = TangentFrame::new(row.normal).expand(row.tangent_impulse);
            for (lane, item) in lanes.iter().enumerate() {
                // SAFETY: by the contract; the manifold of the previous item is no longer used.
                let (manifold, is_calm) = unsafe { contacts.at_end(item.id, item.index) };
                manifold.friction_impulse = friction.get(lane);
                manifold.twist_impulse = NormalMoment::new(row.twist.impulse(lane));
                manifold.friction_owed = row.owed.get(lane);
                let count = usize::from(manifold.count);
                // If sums are not kept, the sum of an earlier step is cleared.
                let sum = block.sums.get(i).copied().unwrap_or([N::ZERO; P]);
                for ((p, point), sum) in manifold.points[..count].iter_mut().zip(&row.points).zip(sum) {
                    p.impulse = point.impulse.get(lane);
                    p.total_impulse = sum.get(lane);
                    if is_calm {
                        p.separation = point.gap.get(lane);
                    }
                }
            }
        }
    }
}
