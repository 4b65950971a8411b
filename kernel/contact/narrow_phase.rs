//! The narrow phase, top to bottom: awake contacts are classified by their boxes and motion, then recycled or
//! recomputed, and results that only the table can store are committed at the end.
//!
//! Helpers are called from here and do not call back: [`recycle`](super::recycle) keeps manifolds,
//! [`manifold_update`] and [`time_of_impact`] compute them, [`impulse_transfer`](super::impulse_transfer)
//! transfers their impulses.
//!
//! An update bounds how far the surfaces may move against each other before the manifold must be recomputed.
//! The bodies may travel half of this distance until the next update: the contact is calm. Each body
//! accumulates an upper bound of its surface's travel. At its end the solver stores the separations if they
//! are valid for the start of the next step.
#![expect(unsafe_code, reason = "several threads change contacts, each other ones")]

use super::impulse_transfer::PreviousManifold;
use super::input::{NarrowPhaseInput, Sides, smaller};
use super::manifold_update::{self, WorkerBuffers};
use super::record::{Contact, ContactFlags, Frozen, Manifold};
use super::table::{ContactTable, PointCount, Stored};
use super::time_of_impact::{self, Meeting};
use crate::data::{BitSet, Parts};
use crate::manifold::{FeatureCache, LocalManifold};
use crate::math::{Vector, max, min};
use crate::shape::Shape;
use crate::table::{BodyPose, NONE, TravelScale};
use crate::thread_pool::ThreadPool;
use crate::tuning::contact::{CALM_SHARE, DEEP};
use crate::tuning::manifold::SAME;

/// The size of a block of contacts, in words of 64 ids. Recycling a block takes some microseconds. Smaller
/// blocks cost more to hand out; larger blocks balance worse.
const BLOCK: usize = 2;

/// The prefetch distance, in contacts. Shorter does not hide the latency of memory; longer evicts
/// records before use.
const PREFETCH_DISTANCE: usize = 4;

impl ContactTable {
    /// Updates all awake contacts. `workers` are buffers, kept between steps. `changed` receives the contacts
    /// that began or ended to touch or whose boxes came apart.
    pub fn update(
        &mut self,
        input: &NarrowPhaseInput,
        pool: &ThreadPool,
        workers: &mut Vec<WorkerBuffers>,
        changed: &mut BitSet,
    ) {
        workers.iter_mut().for_each(WorkerBuffers::clear);
        if self.gives_back {
            workers.clear();
        }
        if workers.len() < pool.workers() {
            workers.resize_with(pool.workers(), WorkerBuffers::default);
        }
        self.forget_changes();
        self.find_crowded(input);
        let Self { contacts, points, active, extra, .. } = self;
        let crowded = self.any_deep.then_some(&self.crowded);
        let update = ContactUpdate {
            input,
            contacts: Parts::of(contacts),
            points: Parts::of(points),
            extra: Parts::of(extra),
            crowded,
        };
        let buffers = Parts::of(workers);
        pool.run(active.blocks(BLOCK), |block, worker| {
            let mut ids = [0; 64 * BLOCK];
            let mut count = 0;
            for id in active.iter_block(BLOCK, block) {
                ids[count] = id;
                count += 1;
            }
            // SAFETY: a worker runs one block at a time, and an id is in one block, once.
            unsafe { update.update_block(&ids[..count], buffers.one(worker)) };
        });
        self.commit(workers, changed);
        self.mark_internal(input, pool, workers);
        self.transfer_impulses(input);
    }

    /// Finds the dynamic bodies that overlap other bodies deeply.
    fn find_crowded(&mut self, input: &NarrowPhaseInput) {
        self.crowded.clear();
        if !self.any_deep {
            return;
        }
        for id in self.active.iter() {
            let contact = &self.contacts[id as usize];
            if contact.flags.has(ContactFlags::DEEP) {
                let dynamic = contact.bodies.into_iter().filter(|body| input.is_dynamic(*body));
                dynamic.for_each(|body| _ = self.crowded.insert(body));
            }
        }
    }

    /// Commits the results of the workers. Manifolds after the first are stored in the order of contacts, not
    /// of workers, so that equal steps give equal tables.
    fn commit(&mut self, workers: &[WorkerBuffers], changed: &mut BitSet) {
        self.any_deep = workers.iter().any(|worker| worker.any_deep);
        let mut stored = core::mem::take(&mut self.stored);
        for (worker, found) in workers.iter().enumerate() {
            found.changed.iter().for_each(|id| _ = changed.insert(*id));
            self.lost.extend_from_slice(&found.lost);
            let mut start = 0;
            for &(contact, count) in &found.stored {
                stored.push(Stored { contact, worker, range: start..start + count });
                start += count;
            }
        }
        stored.sort_unstable_by_key(|stored| stored.contact);
        for Stored { contact, worker, range } in stored.drain(..) {
            self.store_extra(contact, &workers[worker].pool[range]);
        }
        self.stored = stored;
    }
}

/// A running update of all contacts, shared by the workers.
struct ContactUpdate<'a> {
    input: &'a NarrowPhaseInput<'a>,
    contacts: Parts<'a, Contact>,
    points: Parts<'a, PointCount>,
    extra: Parts<'a, Vec<Manifold>>,
    /// The bodies that overlapped other bodies deeply before this update, if there are any.
    crowded: Option<&'a BitSet>,
}

impl<'a> ContactUpdate<'a> {
    /// Updates some contacts.
    ///
    /// # Safety
    /// While it runs no other thread may have one of these contacts, nor its count of points.
    #[inline(always)]
    unsafe fn update_block(&self, ids: &[u32], worker: &mut WorkerBuffers) {
        // A panic in an earlier block may have left contacts in the batch.
        worker.batch.clear();
        ids[..PREFETCH_DISTANCE.min(ids.len())].iter().for_each(|id| self.contacts.prefetch(*id));
        for (i, &id) in ids.iter().enumerate() {
            if let Some(next) = ids.get(i + PREFETCH_DISTANCE) {
                self.contacts.prefetch(*next);
            }
            // SAFETY: by the contract the contact is this thread's, and no reference to it is in use.
            let contact = unsafe { self.contacts.one(id as usize) };
            let mut fixed = [None; 2];
            let sides = self.input.sides(contact, &mut fixed);
            if !sides.fat_boxes_overlap() {
                // SAFETY: as above.
                unsafe { self.separate(id, contact, worker) };
            } else if !sides.is_calm(contact) && !worker.batch.push(id, contact, &sides) {
                // SAFETY: as above.
                self.recompute(id, contact, unsafe { self.points.one(id as usize) }, worker);
            }
            if worker.batch.is_full() {
                // SAFETY: the batch holds contacts of this block, and the references above are no longer in
                // use.
                unsafe { self.recycle_batch(worker) };
            }
        }
        // SAFETY: as above.
        unsafe { self.recycle_batch(worker) };
    }

    /// Recycles the contacts of the batch where the motion allows it, recomputes the others, and
    /// empties the batch.
    ///
    /// # Safety
    /// While it runs no other thread may have one of these contacts, nor its count of points.
    #[inline(always)]
    unsafe fn recycle_batch(&self, worker: &mut WorkerBuffers) {
        worker.batch.evaluate(self.input);
        for place in 0..worker.batch.ids().len() {
            let id = worker.batch.ids()[place];
            // SAFETY: by the contract both belong to this thread; references to the previous contact are no
            // longer in use.
            let (contact, count) = unsafe { (self.contacts.one(id as usize), self.points.one(id as usize)) };
            // SAFETY: a slot belongs to one contact.
            let extra = unsafe { self.extra(contact) };
            if !worker.batch.apply(place, contact, extra) {
                self.recompute(id, contact, count, worker);
                continue;
            }
            let mut fixed = [None; 2];
            let sides = self.input.sides(contact, &mut fixed);
            sides.after_recycling(contact);
            let [allowed, moved] = worker.batch.ways(place);
            contact.calm_down(sides.poses, self.input.bodies.travel_scale, allowed, moved);
            worker.any_deep |= contact.flags.has(ContactFlags::DEEP);
            self.input.note_sliding(id, contact, (extra, !extra.is_empty()), worker);
        }
        worker.batch.clear();
    }

    /// The manifolds of a contact after the first.
    ///
    /// # Safety
    /// While they are in use no other thread may have the contact.
    #[inline(always)]
    unsafe fn extra(&self, contact: &Contact) -> &'a mut [Manifold] {
        match contact.extra {
            NONE => &mut [],
            // SAFETY: a slot belongs to one contact, which is this thread's.
            slot => unsafe { &mut self.extra.one(slot as usize)[..usize::from(contact.extra_count)] },
        }
    }

    /// Notes that the boxes of a contact came apart.
    ///
    /// # Safety
    /// While it runs no other thread may have the contact.
    unsafe fn separate(&self, id: u32, contact: &mut Contact, worker: &mut WorkerBuffers) {
        if let Some(before) = PreviousManifold::of(self.input, contact) {
            // SAFETY: by the contract.
            let extra = unsafe { self.extra(contact) };
            before.note_lost(id, contact, extra, core::iter::empty(), &mut worker.lost);
        }
        contact.flags.set(ContactFlags::SEPARATED, true);
        contact.flags.set(ContactFlags::SLIDES_A.union(ContactFlags::SLIDES_B), false);
        worker.changed.push(id);
        worker.any_deep |= contact.flags.has(ContactFlags::DEEP);
    }

    /// Recomputes a contact, and notes its results for the commit.
    fn recompute(&self, id: u32, contact: &mut Contact, count: &mut PointCount, worker: &mut WorkerBuffers) {
        let is_among = |crowd: &BitSet| contact.bodies.iter().any(|b| *b != NONE && crowd.contains(*b));
        let is_crowded = self.crowded.is_some_and(is_among);
        let touched = contact.flags.has(ContactFlags::TOUCHING);
        // SAFETY: by the contract the contact is this thread's, and its slot belongs to no other.
        let old_extra = unsafe { self.extra(contact) };
        let before = PreviousManifold::of(self.input, contact);
        recompute(self.input, contact, old_extra, is_crowded, worker);
        if let Some(before) = before {
            let new = core::iter::once(&contact.manifold).chain(&worker.extra);
            before.note_lost(id, contact, old_extra, new, &mut worker.lost);
        }
        if touched != contact.flags.has(ContactFlags::TOUCHING) {
            worker.changed.push(id);
        }
        if contact.extra != NONE || !worker.extra.is_empty() {
            worker.stored.push((id, worker.extra.len()));
            worker.pool.extend_from_slice(&worker.extra);
        }
        worker.any_deep |= contact.flags.has(ContactFlags::DEEP);
        let has_more = !worker.extra.is_empty();
        self.input.note_sliding(id, contact, (&[], has_more), worker);
        // Blocks share cache lines of counts, so equal counts are not written.
        let now = PointCount::of(contact);
        if *count != now {
            *count = now;
        }
    }
}

/// Computes the manifolds of a contact at the present poses or, for swept shapes, at the time of impact, and
/// freezes the contact at these poses.
fn recompute(
    input: &NarrowPhaseInput,
    contact: &mut Contact,
    old_extra: &[Manifold],
    is_crowded: bool,
    buffers: &mut WorkerBuffers,
) {
    let mut fixed = [None; 2];
    let sides = input.sides(contact, &mut fixed);
    let revisions = sides.revisions();
    let is_changed = contact.revisions != revisions;
    if is_changed {
        // The cached features may belong to other shapes.
        contact.cache = FeatureCache::NONE;
    }
    contact.revisions = revisions;
    contact.excite(sides.poses);
    buffers.local.clear();
    let mut search = if contact.flags.has(ContactFlags::FOREIGN) {
        search_foreign(&sides, contact, buffers)
    } else if contact.flags.has(ContactFlags::COMPOSITE) {
        search_parts(&sides, contact, buffers)
    } else {
        search_native(&sides, contact, &mut buffers.local)
    };
    if contact.flags.has(ContactFlags::SENSOR) && search.meeting.is_none() {
        let gap = manifold_update::keep_met(&sides, &mut buffers.local);
        search.prediction = min(search.prediction, gap);
    }
    freeze(&sides, contact, &search, &buffers.local);
    manifold_update::replace(&sides, contact, old_extra, search.meeting.as_ref(), buffers);
    if contact.flags.any(ContactFlags::TOUCHING.union(ContactFlags::COMPOSITE)) {
        sides.set_platform(contact);
    }
    // A contact counts as placed if it is new, was changed by hand, or has a body in a crowd of placed
    // bodies. All other contacts were pressed into their overlap.
    sides.after_recomputing(contact, is_crowded || is_changed);
}

/// Result of a manifold search, apart from its points.
struct Search {
    /// Distance up to which points were searched or are known to be absent, margins subtracted.
    prediction: f32,
    /// Pose of the points if not the current one: at the time of impact or in the middle of the step.
    meeting: Option<Meeting>,
    /// Whether there are points beyond `prediction` that turning may close in this step.
    has_far: bool,
}

/// Computes the manifolds of a pair with a foreign shape. The pair is not swept; the search distance includes
/// the distance that turning may close.
fn search_foreign(sides: &Sides, contact: &Contact, buffers: &mut WorkerBuffers) -> Search {
    let (pose, farthest) = sides.input.foreign_view(contact);
    sides.input.source.manifolds(contact.colliders, &pose, farthest, &mut buffers.local);
    Search { prediction: sides.prediction(), meeting: None, has_far: false }
}

/// Computes the manifolds of a pair with a composite shape: of nearby parts, and of parts that the step's
/// motion meets. The search distance includes the distance that turning may close.
fn search_parts(sides: &Sides, contact: &mut Contact, buffers: &mut WorkerBuffers) -> Search {
    let (prediction, margin) = (sides.prediction(), sides.margin());
    let farthest = sides.farthest(prediction);
    let gap = sides.box_gap() - margin;
    if gap > farthest {
        return Search { prediction: gap, meeting: None, has_far: false };
    }
    let near = sides.near();
    let motion = if prediction > near { sides.predicted_motion() } else { Vector::ZERO };
    let turning = farthest - prediction;
    let near = near + turning;
    let met = if time_of_impact::is_straight(sides) {
        time_of_impact::met_at(sides) + turning
    } else {
        f32::INFINITY
    };
    let gap = manifold_update::collide_parts(sides, contact, near + margin, (motion, met + margin), buffers);
    // Without any part the gap is infinite.
    let known = if buffers.local.is_empty() && gap.is_finite() { max(gap - margin, near) } else { near };
    let known = min(known, buffers.composite.passed() - margin);
    Search { prediction: known, meeting: None, has_far: false }
}

/// Computes the manifold of two native shapes at their present poses or, if they do not touch, at their time
/// of impact in the step.
#[inline(always)]
fn search_native(sides: &Sides, contact: &mut Contact, found: &mut Vec<LocalManifold>) -> Search {
    let (prediction, margin) = (sides.prediction(), sides.margin());
    let mut gap = sides.box_gap();
    let mut local = LocalManifold::default();
    let mut meeting = None;
    let mut looked_up_to = prediction;
    let mut until_lag = f32::INFINITY;
    let mut has_far = false;
    let with_margin = prediction + margin;
    let farthest = sides.farthest(prediction);
    // Negated, so that a NaN is not taken for a gap.
    if !(gap > with_margin) || !(gap - margin > farthest) {
        // A touching body may slap down within the step at points that are still far.
        let slaps = farthest > prediction && time_of_impact::is_straight(sides);
        let up_to = if slaps { farthest + margin } else { with_margin };
        until_lag = manifold_update::collide(sides, contact, up_to, &mut local);
        if local.lower_bound() > with_margin {
            local = LocalManifold { gap: local.lower_bound(), ..LocalManifold::default() };
            until_lag = f32::INFINITY;
        }
        has_far = local.points().iter().any(|p| p.separation > with_margin);
        if local.count == 0 {
            // Shapes that turn are often much farther apart than their boxes.
            gap = max(gap, local.gap);
            meeting = time_of_impact::find_meeting(sides, contact, gap - margin, prediction, &mut local);
        } else if prediction > sides.near() && time_of_impact::may_pass_by(sides, &local) {
            gap = max(gap, local.lower_bound());
            looked_up_to = gap - margin;
            let present = local;
            meeting = time_of_impact::find_meeting(sides, contact, gap - margin, prediction, &mut local);
            if meeting.is_none() && !time_of_impact::pushes(sides, &present) {
                local = present;
            }
        }
        if meeting.is_none() && until_lag == f32::INFINITY {
            meeting = time_of_impact::midstep_contact(sides, contact, with_margin, &mut local);
        }
    }
    if local.count == 0 {
        return Search { prediction: max(gap - margin, looked_up_to), meeting: None, has_far: false };
    }
    found.push(local);
    Search { prediction: min(prediction, until_lag), meeting, has_far }
}

/// Freezes a contact at the present poses, or at the poses where its shapes meet. A contact of swept shapes
/// is not recycled. Neither is a sensor's contact with points, which would be kept while the shapes part.
#[inline(always)]
fn freeze(sides: &Sides, contact: &mut Contact, search: &Search, found: &[LocalManifold]) {
    contact.frozen = Frozen {
        rotations: sides.poses.map(|p| p.rotation),
        offset: search.meeting.as_ref().map_or(sides.offset(), |meeting| meeting.offset),
        prediction: search.prediction,
    };
    let is_native = !contact.flags.has(ContactFlags::FOREIGN);
    let is_lasting =
        search.meeting.is_none() && !search.has_far && !found.iter().any(LocalManifold::is_met_later);
    let is_recyclable = sides.input.recycle_distance > 0.0 && is_native && is_lasting;
    let is_kept = found.is_empty() || !contact.flags.has(ContactFlags::SENSOR);
    contact.flags.set(ContactFlags::FROZEN, is_recyclable && is_kept);
}

// What follows from an update: the bits of deep overlap and platform, and how long the contact is calm.

/// A contact with any of these bits is updated in each step.
const LOOKED_AT: ContactFlags = ContactFlags::DEEP
    .union(ContactFlags::COMPOSITE)
    .union(ContactFlags::SENSOR)
    .union(ContactFlags::SLIDES_A)
    .union(ContactFlags::SLIDES_B)
    .union(ContactFlags::CHANGED);

impl Contact {
    /// Whether the next update may leave the contact as it is, if its bodies hardly move until then.
    #[inline(always)]
    pub(crate) fn may_be_calm(&self) -> bool {
        self.flags.has(ContactFlags::FROZEN) && !self.flags.any(LOOKED_AT)
    }

    /// Called when the manifold is recomputed: the next update may not skip the contact.
    #[inline(always)]
    pub(super) fn excite(&mut self, poses: [&BodyPose; 2]) {
        self.calm_until = travel(poses);
        self.flags.set(ContactFlags::CALM, false);
    }

    /// Called after an update. The surfaces may move `allowed` metres before the manifold must be recomputed,
    /// and have moved `moved` metres.
    #[inline(always)]
    pub(super) fn calm_down(&mut self, poses: [&BodyPose; 2], scale: TravelScale, allowed: f32, moved: f32) {
        let way = allowed * CALM_SHARE - moved;
        self.calm_until = travel(poses).wrapping_add(scale.travelled(way));
        // A contact with points becomes calm when the solver stores its separations.
        let is_followed = self.manifold.count == 0 && self.may_be_calm();
        self.flags.set(ContactFlags::CALM, is_followed);
    }
}

/// The sum of both bodies' travels.
#[inline(always)]
fn travel([a, b]: [&BodyPose; 2]) -> u32 {
    a.travel.wrapping_add(b.travel)
}

impl Sides<'_> {
    /// Whether a contact needs no update. A touching contact is calm again only after the solver stores its
    /// separations.
    #[inline(always)]
    pub(super) fn is_calm(&self, contact: &mut Contact) -> bool {
        let &Self { input, poses, .. } = self;
        let flags = contact.flags;
        if !flags.has(ContactFlags::CALM) {
            return false;
        }
        let touches = flags.has(ContactFlags::TOUCHING);
        contact.flags.set(ContactFlags::CALM, !touches);
        let speed = poses[0].speed + poses[1].speed;
        let left = contact.calm_until.wrapping_sub(travel(poses)) as i32;
        let is_near = speed * input.dt < input.bodies.travel_scale.way_of(left);
        if !(is_near && input.recycle_distance > 0.0) || contact.revisions != self.revisions() {
            return false;
        }
        if !touches {
            return true;
        }
        let is_turned = |side: usize, flag| flags.has(flag) && poses[side].speed != 0.0;
        if is_turned(0, ContactFlags::PLATFORM_A) || is_turned(1, ContactFlags::PLATFORM_B) {
            return false;
        }
        input.sliding_side(contact).is_none()
    }

    /// Updates the bits of a recomputed contact: deep overlap, and no change by the embedder. Only a contact
    /// whose bodies were `placed` at their poses can become deep. An inert contact is never deep.
    #[inline(always)]
    pub(super) fn after_recomputing(&self, contact: &mut Contact, placed: bool) {
        let deep = match (contact.flags.has(ContactFlags::DEEP), placed && !contact.is_inert()) {
            (true, _) => self.overlaps_by(SAME, contact),
            (false, true) => self.overlaps_by(DEEP, contact),
            (false, false) => false,
        };
        contact.flags.set(ContactFlags::DEEP, deep);
        contact.flags.set(ContactFlags::CHANGED, false);
    }

    /// Clears the bit of deep overlap if a recycled contact no longer overlaps deeply.
    #[inline(always)]
    pub(super) fn after_recycling(&self, contact: &mut Contact) {
        if contact.flags.has(ContactFlags::DEEP) {
            contact.flags.set(ContactFlags::DEEP, self.overlaps_by(SAME, contact));
        }
    }

    /// Whether the shapes overlap by more than a share of the smaller reach.
    fn overlaps_by(&self, share: f32, contact: &Contact) -> bool {
        let deepest = contact.manifold.points().iter().fold(0.0, |d, p| min(d, p.separation));
        let [a, b] = self.reaches();
        let reach = smaller([a.extent, b.extent]);
        deepest < 0.0 && deepest < -share * reach
    }

    /// Sets the bits of the platform, the body that contacts do not turn. Two round shapes have no platform,
    /// because one can roll under an unchanged normal. A curved shape on its flat end is not round.
    #[inline(always)]
    pub(super) fn set_platform(&self, contact: &mut Contact) {
        let is_round = |side: usize| match self.shapes()[side] {
            Shape::Ball(_) | Shape::Capsule(_) | Shape::Segment(_) => true,
            Shape::Curved(_) => contact.manifold.radii[side] != 0.0,
            _ => false,
        };
        let are_round = is_round(0) && is_round(1);
        let [a, b] = self.are_dynamic().map(|is_dynamic| !are_round && !is_dynamic);
        contact.flags.set(ContactFlags::PLATFORM_A, a);
        contact.flags.set(ContactFlags::PLATFORM_B, b && !a);
    }
}
