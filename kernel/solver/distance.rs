//! Distance constraints: two points of two bodies are kept at a distance, rigidly or by a spring.
//!
//! With the vector d from A's point to B's, n = d / |d| and C = |d| − L, the velocity along n is to be −β C: one row,
//! λ' = λ − m k_m (n·v + β C) − k_i λ, with the coefficients of [`Softness`]. n and the arms follow the exact motion of
//! the bodies, so that long swings keep their length.
//!
//! A rod has the stiff softness of contacts. The part β C is a split impulse: it moves the bodies, is removed from the
//! velocities before the relax pass, and is not warm started. If it stayed, one relax pass would leave most of it in
//! the slow modes of a chain: a chain of 20 links swung along itself with growing speed. A spring keeps its whole
//! impulse and has no relax pass: its implicit step is complete.
#![expect(unsafe_code, reason = "blocks of one stage are changed at once")]

use super::batch::{Batch, Filling, Item, Pass, Passes, Sweep};
use super::layer::{Layer, Sorter};
use super::pair::Pair;
use super::{BodyRow, InvMass, MassRow, RowView, Softness, SubstepParams};
use crate::contact::{Link, ManifoldsView};
use crate::data::Parts;
use crate::graph::{ColorGraph, ConstraintKind};
use crate::math::{Angular, Entry, Ids, InvInertia, Job, Lane, Vector};
use core::fmt;
use core::ops::Range;

/// Stiffness and damping of a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Frequency of the undamped oscillation, in Hz. Positive.
    pub frequency: f32,
    /// Damping ratio: 0 for none, 1 for critical damping.
    pub damping_ratio: f32,
}

/// Definition of a distance constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Two different bodies.
    pub bodies: [u32; 2],
    /// The point on each body, in its frame, in metres.
    pub anchors: [Vector; 2],
    /// The distance, in metres. Positive.
    pub length: f32,
    /// The spring, or `None` for a rigid rod.
    pub spring: Option<Spring>,
}

/// Why a distance cannot be added or removed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DistanceError {
    /// Both ends are on one body.
    SameBody(u32),
    /// There is no body with this id.
    NoBody(u32),
    /// There is no distance with this id.
    NoDistance(u32),
    /// The length is not finite, or not positive.
    Length(f32),
    /// An anchor is not finite.
    Anchor(Vector),
    /// The frequency is not finite and positive, or the damping ratio not finite or negative.
    Spring(Spring),
}

impl fmt::Display for DistanceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SameBody(body) => write!(f, "both ends are on body {body}"),
            Self::NoBody(body) => write!(f, "there is no body {body}"),
            Self::NoDistance(id) => write!(f, "there is no distance {id}"),
            Self::Length(length) => write!(f, "a length of {length} m is not finite and positive"),
            Self::Anchor(anchor) => write!(f, "the anchor {anchor:?} is not finite"),
            Self::Spring(spring) => write!(f, "{spring:?} is not finite and positive"),
        }
    }
}

impl core::error::Error for DistanceError {}

/// State of a distance between steps.
#[derive(Clone, Copy, Debug)]
struct Record {
    anchors: [Vector; 2],
    length: f32,
    spring: Option<Spring>,
    /// Impulse along the vector from A's point to B's, N·s, for the warm start of the next step.
    impulse: f32,
}

/// All distances by id. Their bodies are in [`BodyTable::constraints`](crate::table::BodyTable::constraints).
#[derive(Clone, Debug, Default)]
pub struct DistanceTable {
    /// Records by id. Those of free ids are stale.
    records: Vec<Record>,
}

const KIND: ConstraintKind = ConstraintKind::Distance;

impl DistanceTable {
    /// Adds a distance and wakes its bodies. They are in one island if both are dynamic.
    pub fn add(&mut self, link: &mut Link, def: Distance) -> Result<u32, DistanceError> {
        let Distance { bodies: [a, b], anchors, length, spring } = def;
        if let Some(dead) = [a, b].into_iter().find(|body| !link.bodies.ids.is_live(*body)) {
            return Err(DistanceError::NoBody(dead));
        }
        if a == b {
            return Err(DistanceError::SameBody(a));
        }
        if !(length.is_finite() && length > 0.0) {
            return Err(DistanceError::Length(length));
        }
        if let Some(anchor) = anchors.into_iter().find(|anchor| !anchor.is_finite()) {
            return Err(DistanceError::Anchor(anchor));
        }
        let is_valid = |s: &Spring| {
            let [frequency, damping] = [s.frequency, s.damping_ratio];
            frequency.is_finite() && frequency > 0.0 && damping.is_finite() && damping >= 0.0
        };
        if let Some(spring) = spring.filter(|spring| !is_valid(spring)) {
            return Err(DistanceError::Spring(spring));
        }
        let id = link.connect(KIND, [a, b]);
        let record = Record { anchors, length, spring, impulse: 0.0 };
        match self.records.get_mut(id as usize) {
            Some(place) => *place = record,
            None => self.records.push(record),
        }
        Ok(id)
    }

    /// Removes a distance and wakes its bodies.
    pub fn remove(&mut self, link: &mut Link, id: u32) -> Result<(), DistanceError> {
        if !link.bodies.constraints(KIND).is_live(id) {
            return Err(DistanceError::NoDistance(id));
        }
        link.disconnect(KIND, id);
        Ok(())
    }

    /// The impulse of the last substep, N·s. Positive if it pushes the points apart. 0 for an unknown id.
    pub fn impulse(&self, id: u32) -> f32 {
        self.records.get(id as usize).map_or(0.0, |record| record.impulse)
    }
}

/// The distances of `N::WIDTH` lanes.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Row<N: Lane> {
    ids: [N::Ids; 2],
    /// Inverse mass along each world axis, 1/kg. 0 along locked axes.
    inv_mass: [Vector<N>; 2],
    inv_inertia: [InvInertia<N>; 2],
    /// From the centres of mass to the points, at the start of the step.
    arms: [Vector<N>; 2],
    /// From A's centre of mass to B's, at the start of the step.
    offset: Vector<N>,
    length: N,
    bias_rate: N,
    mass_scale: N,
    impulse_scale: N,
    /// 1 for a spring, else 0.
    is_spring: N,
    impulse: N,
    /// Split impulse that corrects the length in this substep.
    split_impulse: N,
}

impl<N: Lane> Default for Row<N> {
    fn default() -> Self {
        Self {
            ids: [N::Ids::splat(0); 2],
            inv_mass: [Vector::ZERO; 2],
            inv_inertia: [InvInertia::ZERO; 2],
            arms: [Vector::ZERO; 2],
            offset: Vector::ZERO,
            length: N::ZERO,
            bias_rate: N::ZERO,
            mass_scale: N::ZERO,
            impulse_scale: N::ZERO,
            is_spring: N::ZERO,
            impulse: N::ZERO,
            split_impulse: N::ZERO,
        }
    }
}

/// The axis of a row at the current poses.
struct Axis<N> {
    normal: Vector<N>,
    moments: [Angular<N>; 2],
    /// Current distance of the points.
    distance: N,
}

/// Minimum distance of two points, in metres, for which the vector between them has a direction.
const COINCIDENT: f32 = 1.0e-6;

impl<N: Lane> Row<N> {
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the row.
    #[inline(always)]
    unsafe fn axis(&self, bodies: &RowView<BodyRow>) -> Axis<N> {
        // SAFETY: by the contract.
        let [(pa, qa), (pb, qb)] = unsafe {
            [
                BodyRow::gather_delta::<N>(bodies, &self.ids[0]),
                BodyRow::gather_delta::<N>(bodies, &self.ids[1]),
            ]
        };
        let [ra, rb] = [qa.rotate(self.arms[0]), qb.rotate(self.arms[1])];
        let d = self.offset + pb - pa + rb - ra;
        let distance = d.length();
        let is_apart = N::splat(COINCIDENT).lt(distance);
        let scaled = d * (N::ONE / N::select(is_apart, distance, N::ONE));
        let normal = Vector::select(is_apart, scaled, Vector::splat(Vector::X));
        Axis { normal, moments: [ra.cross(normal), rb.cross(normal)], distance }
    }

    /// Applies an impulse along the axis.
    #[inline(always)]
    fn push(&self, pair: &mut Pair<N>, axis: &Axis<N>, impulse: N) {
        let p = axis.normal * impulse;
        pair.v[0] -= self.inv_mass[0].apply(p);
        pair.w[0] -= self.inv_inertia[0].apply(axis.moments[0] * impulse);
        pair.v[1] += self.inv_mass[1].apply(p);
        pair.w[1] += self.inv_inertia[1].apply(axis.moments[1] * impulse);
    }

    /// The effective mass along the axis, kg. 0 if both bodies are immovable along it.
    #[inline(always)]
    fn mass(&self, axis: &Axis<N>) -> N {
        let (n, [ma, mb]) = (axis.normal, axis.moments);
        let linear = n.dot(self.inv_mass[0].apply(n)) + n.dot(self.inv_mass[1].apply(n));
        let turning = ma.dot(self.inv_inertia[0].apply(ma)) + mb.dot(self.inv_inertia[1].apply(mb));
        let k = linear + turning;
        let gives_way = N::ZERO.lt(k);
        N::select(gives_way, N::ONE / N::select(gives_way, k, N::ONE), N::ZERO)
    }

    /// # Safety
    /// Until it returns, no other thread reads or writes those bodies of the row that may be written, or writes the others.
    #[inline(always)]
    unsafe fn warm_start(&self, bodies: &RowView<BodyRow>) {
        // SAFETY: by the contract.
        unsafe {
            let axis = self.axis(bodies);
            let mut pair = Pair::load(bodies, &self.ids);
            self.push(&mut pair, &axis, self.impulse);
            pair.store(bodies, &self.ids);
        }
    }

    /// # Safety
    /// Until it returns, no other thread reads or writes those bodies of the row that may be written, or writes the others.
    #[inline(always)]
    unsafe fn solve(&mut self, bodies: &RowView<BodyRow>) {
        // SAFETY: by the contract.
        let (axis, mut pair) = unsafe { (self.axis(bodies), Pair::load(bodies, &self.ids)) };
        let speed = pair.along(axis.normal, axis.moments);
        let mass = self.mass(&axis) * self.mass_scale;
        let kept = mass * speed + self.impulse_scale * self.impulse;
        let bias = mass * self.bias_rate * (axis.distance - self.length);
        let is_spring = N::ZERO.lt(self.is_spring);
        self.impulse = self.impulse - kept - N::select(is_spring, bias, N::ZERO);
        self.split_impulse = N::select(is_spring, N::ZERO, -bias);
        self.push(&mut pair, &axis, -(kept + bias));
        // SAFETY: by the contract.
        unsafe { pair.store(bodies, &self.ids) };
    }

    /// Removes the split impulse from the velocities, after it has moved the bodies.
    ///
    /// # Safety
    /// Until it returns, no other thread reads or writes those bodies of the row that may be written, or writes the others.
    #[inline(always)]
    unsafe fn undo_split(&mut self, bodies: &RowView<BodyRow>) {
        // SAFETY: by the contract.
        unsafe {
            let axis = self.axis(bodies);
            let mut pair = Pair::load(bodies, &self.ids);
            self.push(&mut pair, &axis, -self.split_impulse);
            pair.store(bodies, &self.ids);
        }
    }

    /// # Safety
    /// Until it returns, no other thread reads or writes those bodies of the row that may be written, or writes the others.
    #[inline(always)]
    unsafe fn relax(&mut self, bodies: &RowView<BodyRow>) {
        // SAFETY: by the contract.
        let (axis, mut pair) = unsafe { (self.axis(bodies), Pair::load(bodies, &self.ids)) };
        let change = self.mass(&axis) * pair.along(axis.normal, axis.moments);
        let change = N::select(N::ZERO.lt(self.is_spring), N::ZERO, change);
        self.impulse -= change;
        self.push(&mut pair, &axis, -change);
        // SAFETY: by the contract.
        unsafe { pair.store(bodies, &self.ids) };
    }

    /// Copies a distance into a lane.
    #[inline(always)]
    fn set(&mut self, lane: usize, record: &Record, bodies: [u32; 2], from: &Filling) {
        let table = from.input.bodies;
        let poses = bodies.map(|body| &table.poses[body as usize]);
        for side in 0..2 {
            let row = from.input.row_of(bodies[side]);
            self.ids[side].set(lane, row);
            let arm = record.anchors[side] - table[bodies[side]].local_center;
            self.arms[side].set(lane, poses[side].rotation.rotate(arm));
            let locks = from.locks.get(row as usize).filter(|locks| locks.is_translation_held());
            // 1 along free axes, until the mass is known.
            self.inv_mass[side].set(lane, locks.map_or(Vector::ONE, |locks| locks.translation_factors()));
        }
        self.offset.set(lane, (poses[1].center - poses[0].center).to_local());
        self.length.set(lane, record.length);
        let SubstepParams { h, stiff, warm_start, .. } = *from.params;
        let softness = record.spring.map_or(stiff, |s| Softness::new(s.frequency, s.damping_ratio, h));
        self.bias_rate.set(lane, softness.bias_rate);
        self.mass_scale.set(lane, softness.mass_scale);
        self.impulse_scale.set(lane, softness.impulse_scale);
        self.is_spring.set(lane, if record.spring.is_some() { 1.0 } else { 0.0 });
        self.impulse.set(lane, record.impulse * warm_start);
    }

    /// Computes derived values, for all lanes at once.
    #[inline(always)]
    fn finish(&mut self, masses: &[MassRow]) {
        for side in 0..2 {
            let (inv_mass, inertia) = MassRow::gather::<N>(masses, &self.ids[side]);
            self.inv_mass[side] = InvMass::new(inv_mass, self.inv_mass[side]);
            self.inv_inertia[side] = inertia;
        }
    }
}

/// The rows of one width. The last ones may be unused.
#[derive(Clone, Debug, Default)]
pub(super) struct DistanceRows<N: Lane>(Vec<Row<N>>);

/// Number of batches of distances in one width.
pub(super) const DISTANCE_BATCHES: usize = 1;

/// The distances of a colour.
pub(super) fn distances(colors: &ColorGraph, color: u8) -> &[u32] {
    colors.constraints(KIND, color)
}

/// Sorts distances into a layer, as items of a batch.
pub(super) fn sort_distances(distances: &[u32], batch: usize, sorter: &Sorter, layer: &mut Layer) {
    let parts = layer.parts();
    for &id in distances {
        let bodies = sorter.input.bodies.constraints(KIND).get(id).bodies;
        layer.push(sorter.part(id, bodies, parts), batch, Item { id, index: 0 });
    }
}

impl<N: Entry> DistanceRows<N> {
    /// Resizes the rows. Their content is stale.
    pub(super) fn make_room(&mut self, rows: u32) {
        if self.0.len() < rows as usize {
            self.0.resize(rows as usize, Row::default());
        }
    }

    pub(super) fn view<'a>(&'a mut self, proof: N::Proof, records: &'a Records<'a>) -> DistanceView<'a, N> {
        DistanceView { proof, rows: Parts::of(&mut self.0), records }
    }
}

/// The records of all distances, changed by several threads.
pub(super) struct Records<'a>(Parts<'a, Record>);

impl DistanceTable {
    pub(super) fn records(&mut self) -> Records<'_> {
        Records(Parts::of(&mut self.records))
    }
}

/// A view of the rows of one width whose blocks are changed by several threads.
pub(super) struct DistanceView<'a, N: Entry> {
    proof: N::Proof,
    rows: Parts<'a, Row<N>>,
    records: &'a Records<'a>,
}

impl<N: Entry> Batch for DistanceView<'_, N> {
    unsafe fn fill(&self, rows: Range<usize>, items: &[Item], from: &Filling) -> Passes {
        let constraints = from.input.bodies.constraints(KIND);
        // SAFETY: by the contract.
        let rows = unsafe { self.rows.take(rows) };
        for (row, lanes) in rows.iter_mut().zip(items.chunks(N::WIDTH)) {
            *row = Row::default();
            for (lane, item) in lanes.iter().enumerate() {
                // SAFETY: a distance is in one row, so by the contract no other thread has its record.
                let record = unsafe { self.records.0.one(item.id as usize) };
                row.set(lane, record, constraints.get(item.id).bodies, from);
            }
        }
        // SAFETY: the job has no further condition.
        unsafe { N::enter(self.proof, FinishJob { rows, masses: from.masses }) };
        Passes::BASIC.with(Pass::UndoSplit)
    }

    unsafe fn run(&self, rows: Range<usize>, _: Passes, sweep: &Sweep) -> bool {
        let pass = match sweep.pass {
            Pass::WarmStart => Work::WarmStart,
            Pass::Solve => Work::Solve,
            Pass::UndoSplit => Work::UndoSplit,
            Pass::Relax => Work::Relax,
            Pass::Impact | Pass::Restitute => return false,
        };
        // SAFETY: by the contract.
        unsafe { N::enter(self.proof, RunJob { rows: self.rows.take(rows), bodies: sweep.bodies, pass }) };
        false
    }

    unsafe fn store(&self, rows: Range<usize>, items: &[Item], _: &ManifoldsView) {
        // SAFETY: by the contract.
        let rows = unsafe { self.rows.take(rows) };
        for (row, lanes) in rows.iter().zip(items.chunks(N::WIDTH)) {
            for (lane, item) in lanes.iter().enumerate() {
                // SAFETY: a distance is in one row, so by the contract no other thread has its record.
                unsafe { self.records.0.one(item.id as usize) }.impulse = row.impulse.get(lane);
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

/// What a pass does with distances.
#[derive(Clone, Copy)]
enum Work {
    WarmStart,
    Solve,
    UndoSplit,
    Relax,
}

struct RunJob<'a, N: Lane> {
    rows: &'a mut [Row<N>],
    bodies: RowView<'a, BodyRow>,
    pass: Work,
}

impl<N: Lane> Job for RunJob<'_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        for row in self.rows.iter_mut() {
            // SAFETY: by the contract.
            unsafe {
                match self.pass {
                    Work::WarmStart => row.warm_start(&self.bodies),
                    Work::Solve => row.solve(&self.bodies),
                    Work::UndoSplit => row.undo_split(&self.bodies),
                    Work::Relax => row.relax(&self.bodies),
                }
            }
        }
    }
}
