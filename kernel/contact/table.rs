//! All contacts by id, the map from pairs to contacts, the set of awake contacts, and contacts that the
//! embedder changes between the narrow phase and the solver.

use super::record::{
    Contact, ContactFlags, LoadPoint, LostImpulse, Manifold, ManifoldPoint, ManifoldSurface,
};
use crate::data::{BitSet, IdPool, PairSet, Parts, Slack, prefetch};
use crate::math::DIM;
use crate::table::{ColliderTable, NONE};
use std::collections::BTreeMap;

/// All contacts.
///
/// One dense array by id with the first manifold inline. Native pairs have one manifold, so a step follows no
/// pointer and allocates nothing. Further manifolds, of composite and foreign shapes, are in a side pool.
#[derive(Clone, Debug, Default)]
pub struct ContactTable {
    ids: IdPool,
    pub(super) contacts: Vec<Contact>,
    /// The number of points of each contact.
    pub(super) points: Vec<PointCount>,
    /// A copy of each contact's bodies, for readers that need no other field of the record.
    bodies: Vec<[u32; 2]>,
    pairs: PairSet,
    /// Contacts with an awake body.
    pub(super) active: BitSet,
    /// Contacts that are active in this update only.
    pub(super) visited: Vec<u32>,
    /// Whether the solver sums the impulses of each point over the substeps of a step, for apps that read
    /// them. Off by default: it costs time.
    pub sum_impulses: bool,
    /// Whether the last update found a deeply overlapping contact.
    pub(crate) any_deep: bool,
    /// The dynamic bodies that overlapped other bodies deeply when contacts were last updated.
    pub(super) crowded: BitSet,
    pub(super) extra: Vec<Vec<Manifold>>,
    free_extra: Vec<u32>,
    /// Buffer of the narrow phase's commit; empty between updates.
    pub(super) stored: Vec<Stored>,
    /// The surfaces of changed manifolds, by contact and index.
    pub(super) surfaces: BTreeMap<(u32, u32), ManifoldSurface>,
    /// Bodies whose mass the solver raised in the last step, by id, and how long the raise lasts.
    pub(crate) raised_masses: Vec<(u32, [u8; DIM])>,
    /// Sliding colliders whose manifolds are compared; empty between updates.
    pub(super) compared: Vec<u32>,
    /// The colliders of `compared` as a set.
    pub(super) is_compared: BitSet,
    /// Colliders that slide; empty between updates.
    pub(super) sliders: BitSet,
    /// Loaded points that sliding colliders lost; empty between updates.
    pub(super) lost: Vec<LostImpulse>,
    /// The points of a sliding collider; empty between updates.
    pub(super) load_points: Vec<LoadPoint>,
    /// The number of contacts, step by step.
    slack: Slack,
    /// One more than the highest id in use, step by step.
    span: Slack,
    /// Whether storage behind the last contact is given back when ids are next recycled.
    is_cut: bool,
    /// Whether lists and buffers of contacts are given back, from the end of an update to that of the next.
    pub(super) gives_back: bool,
}

/// Truncates a list and releases its unused storage.
fn cut<T>(list: &mut Vec<T>, len: usize) {
    list.truncate(len);
    list.shrink_to_fit();
}

/// Manifolds after the first that a worker computed.
#[derive(Clone, Debug)]
pub(super) struct Stored {
    pub(super) contact: u32,
    pub(super) worker: usize,
    /// The range in the worker's pool.
    pub(super) range: core::ops::Range<usize>,
}

/// The number of points of a contact, in an array beside the records: counting does not load the records.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct PointCount(u8);

impl PointCount {
    const IN_RECORD: u8 = u8::MAX;

    /// The solved points of the first manifold; `None` if there may be more manifolds, which the record
    /// lists.
    #[inline(always)]
    pub(crate) fn of_only_manifold(self) -> Option<u32> {
        (self.0 != Self::IN_RECORD).then_some(u32::from(self.0))
    }

    #[inline(always)]
    pub(super) fn of(contact: &Contact) -> Self {
        match contact.extra {
            NONE => Self(contact.manifold.solved_points() as u8),
            _ => Self(Self::IN_RECORD),
        }
    }
}

impl ContactTable {
    /// The bytes stored per contact, without two bits, the [`pairs`](Self::pairs), and manifolds after the
    /// first.
    pub const BYTES_PER_CONTACT: usize =
        size_of::<Contact>() + size_of::<PointCount>() + size_of::<[u32; 2]>();

    /// The number of contacts.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are no contacts.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One more than the highest id ever used.
    pub fn capacity(&self) -> usize {
        self.contacts.len()
    }

    /// Whether an id is in use.
    pub fn is_live(&self, id: u32) -> bool {
        self.ids.is_live(id)
    }

    /// The contacts with an awake body, by id.
    pub fn active(&self) -> impl Iterator<Item = u32> + '_ {
        self.active.iter()
    }

    /// The number of contacts with an awake body; O(capacity).
    pub fn active_len(&self) -> usize {
        self.active.count()
    }

    /// Whether a contact has an awake body.
    pub fn is_active(&self, id: u32) -> bool {
        self.active.contains(id)
    }

    /// All contacts, by id.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &Contact)> {
        (0..self.contacts.len() as u32).filter(|id| self.is_live(*id)).map(|id| (id, self.get(id)))
    }

    /// The contact of two colliders, in either order.
    pub fn find(&self, a: u32, b: u32) -> Option<u32> {
        self.pairs.get(a.min(b), a.max(b))
    }

    /// The map from pairs of colliders to contacts.
    pub fn pairs(&self) -> &PairSet {
        &self.pairs
    }

    /// The number of points of a contact.
    #[inline(always)]
    pub(crate) fn point_count(&self, id: u32) -> PointCount {
        self.points[id as usize]
    }

    /// The bodies that a contact's colliders belong to, or [`NONE`].
    #[inline(always)]
    pub(crate) fn bodies_of(&self, id: u32) -> [u32; 2] {
        self.bodies[id as usize]
    }

    /// Prefetches contacts that are needed soon. Ids without a contact are skipped.
    #[inline(always)]
    pub(crate) fn prefetch(&self, ids: &[u32]) {
        for id in ids {
            prefetch(&self.contacts, *id);
        }
    }

    /// A contact.
    #[inline(always)]
    pub fn get(&self, id: u32) -> &Contact {
        debug_assert!(self.is_live(id), "contact {id} is in use");
        &self.contacts[id as usize]
    }

    /// A contact.
    #[inline(always)]
    pub(crate) fn get_mut(&mut self, id: u32) -> &mut Contact {
        debug_assert!(self.is_live(id), "contact {id} is in use");
        &mut self.contacts[id as usize]
    }

    /// A contact's manifold by its number, which must exist.
    #[inline(always)]
    pub(crate) fn manifold_mut(&mut self, id: u32, index: u32) -> &mut Manifold {
        let contact = &mut self.contacts[id as usize];
        match index {
            0 => &mut contact.manifold,
            _ => &mut self.extra[contact.extra as usize][index as usize - 1],
        }
    }

    /// A view of the manifolds for several threads.
    pub(crate) fn manifolds_view(&mut self) -> ManifoldsView<'_> {
        ManifoldsView { contacts: Parts::of(&mut self.contacts), extra: Parts::of(&mut self.extra) }
    }

    /// A contact's manifold by its number, if it exists.
    #[inline(always)]
    pub fn manifold<'a>(&'a self, contact: &'a Contact, index: u32) -> Option<&'a Manifold> {
        match index {
            0 => Some(&contact.manifold),
            _ => self.extra_of(contact).get(index as usize - 1),
        }
    }

    /// The manifolds of a contact after the first.
    pub fn extra_of(&self, contact: &Contact) -> &[Manifold] {
        match contact.extra {
            NONE => &[],
            slot => &self.extra[slot as usize][..usize::from(contact.extra_count)],
        }
    }

    /// Makes ids that were freed before this usable again; call it in every step. Releases storage that only
    /// a past crowd needed.
    pub fn recycle_ids(&mut self) {
        self.ids.recycle();
        if core::mem::take(&mut self.is_cut) {
            self.ids.trim();
            let capacity = self.ids.capacity();
            cut(&mut self.contacts, capacity);
            cut(&mut self.points, capacity);
            cut(&mut self.bodies, capacity);
            self.active.truncate(capacity);
            for slot in &self.free_extra {
                self.extra[*slot as usize] = Vec::new();
            }
        }
    }

    /// Counts a step, and decides what to give back. Contacts keep their ids, so the table is cut later than
    /// lists, when the highest ids are free.
    pub(super) fn count_step(&mut self) {
        self.is_cut |= self.span.is_due(self.ids.span());
        self.gives_back = self.slack.is_due(self.len());
        if self.gives_back {
            self.pairs.shrink();
        }
    }

    pub(super) fn store_extra(&mut self, id: u32, manifolds: &[Manifold]) {
        debug_assert!(self.is_live(id), "contact {id} is in use");
        let contact = &mut self.contacts[id as usize];
        if contact.extra == NONE {
            contact.extra = self.free_extra.pop().unwrap_or_else(|| {
                self.extra.push(Vec::new());
                self.extra.len() as u32 - 1
            });
        }
        let count = manifolds.len().min(usize::from(u16::MAX));
        contact.extra_count = count as u16;
        let stored = &mut self.extra[contact.extra as usize];
        stored.clear();
        stored.extend_from_slice(&manifolds[..count]);
        self.points[id as usize] = PointCount::of(&self.contacts[id as usize]);
    }

    /// Adds the contact of a pair that has none to all lists of both colliders. It is not active yet.
    pub(super) fn add(&mut self, contact: Contact, colliders: &mut ColliderTable) -> u32 {
        // Inert contacts have no colour, and must not change the order of contacts with a colour.
        let id = if contact.is_inert() { self.ids.allocate_aside() } else { self.ids.allocate() };
        let [a, b] = contact.colliders;
        debug_assert!(a < b, "the lower collider comes first: {a}, {b}");
        debug_assert!(self.find(a, b).is_none(), "colliders {a} and {b} have no contact yet");
        debug_assert!([a, b].iter().all(|c| colliders.ids.is_live(*c)), "colliders {a} and {b} are in use");
        debug_assert_eq!(
            contact.bodies,
            [a, b].map(|c| colliders[c].def.body),
            "bodies are those of the colliders"
        );
        debug_assert_eq!(contact.extra, NONE, "a new contact has no manifolds in the side pool");
        self.pairs.insert(a, b, id);
        if id as usize == self.contacts.len() {
            self.bodies.push(contact.bodies);
            self.contacts.push(contact);
            self.points.push(PointCount::default());
        } else {
            self.bodies[id as usize] = contact.bodies;
            self.contacts[id as usize] = contact;
            self.points[id as usize] = PointCount::default();
        }
        for side in 0..2 {
            let collider = self.contacts[id as usize].colliders[side];
            let edge = id << 1 | side as u32;
            let first = core::mem::replace(&mut colliders[collider].first_contact, edge);
            self.contacts[id as usize].next[side] = first;
            if first != NONE {
                self.contacts[(first >> 1) as usize].previous[(first & 1) as usize] = edge;
            }
        }
        id
    }

    /// Removes a contact from all lists except colours and islands, and frees its id.
    pub(super) fn remove(&mut self, id: u32, colliders: &mut ColliderTable) {
        self.deactivate(id);
        self.forget_surfaces(id);
        let Contact { colliders: [a, b], next, previous, extra, .. } = *self.get(id);
        debug_assert_eq!(self.find(a, b), Some(id), "the pair's contact is this one");
        self.pairs.remove(a, b);
        for side in 0..2 {
            match previous[side] {
                NONE => colliders[[a, b][side]].first_contact = next[side],
                edge => self.contacts[(edge >> 1) as usize].next[(edge & 1) as usize] = next[side],
            }
            if next[side] != NONE {
                self.contacts[(next[side] >> 1) as usize].previous[(next[side] & 1) as usize] =
                    previous[side];
            }
        }
        if extra != NONE {
            self.extra[extra as usize].clear();
            self.free_extra.push(extra);
        }
        self.ids.free(id);
    }

    pub(super) fn activate(&mut self, id: u32) {
        debug_assert!(self.is_live(id), "contact {id} is in use");
        self.active.insert(id);
        // The bodies have travelled meanwhile, and the travel may have wrapped around.
        self.contacts[id as usize].flags.set(ContactFlags::CALM, false);
    }

    pub(super) fn deactivate(&mut self, id: u32) {
        self.active.remove(id);
    }

    /// The contacts of a collider.
    pub fn of_collider<'a>(
        &'a self,
        collider: u32,
        colliders: &ColliderTable,
    ) -> impl Iterator<Item = u32> + 'a {
        let first = colliders[collider].first_contact;
        core::iter::successors((first != NONE).then_some(first), |edge| {
            let next = self.contacts[(edge >> 1) as usize].next[(edge & 1) as usize];
            (next != NONE).then_some(next)
        })
        .map(|edge| edge >> 1)
    }

    /// Checks every list against every record.
    ///
    /// # Panics
    ///
    /// If an invariant does not hold; the message names it.
    pub fn validate(&self, colliders: &ColliderTable) {
        assert!(self.active.iter().all(|id| self.is_live(id)), "an active contact is live");
        let mut live = 0;
        for (id, contact) in self.iter() {
            live += 1;
            assert_eq!(self.points[id as usize], PointCount::of(contact), "points are counted");
            assert_eq!(self.bodies[id as usize], contact.bodies, "bodies are as in the record");
            let [a, b] = contact.colliders;
            assert!(a < b, "the lower collider comes first");
            assert_eq!(self.find(a, b), Some(id), "a contact is found by its pair");
            for c in [a, b] {
                assert!(colliders.ids.is_live(c), "a contact's colliders are live");
            }
            assert_eq!(contact.bodies, [a, b].map(|c| colliders[c].def.body), "a contact knows its bodies");
        }
        let mut listed = 0;
        for collider in colliders.ids.iter() {
            for id in self.of_collider(collider, colliders) {
                assert!(
                    self.is_live(id) && self.get(id).colliders.contains(&collider),
                    "lists hold their own"
                );
                listed += 1;
            }
        }
        assert_eq!(listed, 2 * live, "colliders list their contacts");
        assert_eq!(live, self.len());
        assert_eq!(self.pairs.len(), live, "every pair has one contact");
    }
}

impl ContactTable {
    /// Replaces the manifolds of a contact after the update of this step; the next update computes them anew.
    /// `changed` holds the contacts that began or ended in the update; this contact is inserted or removed to
    /// match its new state.
    ///
    /// Manifolds without points, or with values that are not finite, are left out.
    pub fn change(
        &mut self,
        id: u32,
        manifolds: impl Iterator<Item = (Manifold, ManifoldSurface)>,
        changed: &mut BitSet,
    ) {
        let touched = self.get(id).flags.has(ContactFlags::TOUCHING) != changed.contains(id);
        let mut kept = Vec::new();
        for (manifold, surface) in manifolds.filter(|(manifold, surface)| is_usable(manifold, surface)) {
            self.surfaces.insert((id, kept.len() as u32), surface);
            kept.push(manifold);
        }
        let contact = &mut self.contacts[id as usize];
        contact.manifold = kept.first().copied().unwrap_or_default();
        contact.flags.set(ContactFlags::TOUCHING, !kept.is_empty());
        contact.flags.set(ContactFlags::CHANGED, true);
        // The frozen manifold is the embedder's: the next update must not recycle it.
        contact.flags.set(ContactFlags::FROZEN, false);
        if contact.extra != NONE || kept.len() > 1 {
            self.store_extra(id, kept.get(1..).unwrap_or_default());
        }
        self.points[id as usize] = PointCount::of(&self.contacts[id as usize]);
        if touched == kept.is_empty() {
            changed.insert(id);
        } else {
            changed.remove(id);
        }
    }

    /// Forgets the changed surfaces of active contacts, which the update recomputes. Contacts at rest keep
    /// theirs.
    pub(super) fn forget_changes(&mut self) {
        let active = &self.active;
        self.surfaces.retain(|(id, _), _| !active.contains(*id));
    }

    /// Forgets the surfaces of one contact.
    pub(super) fn forget_surfaces(&mut self, id: u32) {
        if self.contacts[id as usize].flags.has(ContactFlags::CHANGED) {
            self.surfaces.retain(|(contact, _), _| *contact != id);
        }
    }

    /// The surface of a manifold of a changed contact.
    pub fn changed_surface(&self, id: u32, index: u32) -> Option<&ManifoldSurface> {
        self.surfaces.get(&(id, index))
    }
}

/// The manifolds of all contacts, changed by several threads at once.
pub(crate) struct ManifoldsView<'a> {
    contacts: Parts<'a, Contact>,
    extra: Parts<'a, Vec<Manifold>>,
}

#[expect(unsafe_code, reason = "several threads change manifolds, each of other contacts")]
impl ManifoldsView<'_> {
    /// Prefetches contacts that are needed soon. Ids without a contact are skipped.
    #[inline(always)]
    pub(crate) fn prefetch(&self, ids: &[u32]) {
        ids.iter().for_each(|id| self.contacts.prefetch(*id));
    }

    /// A contact's manifold by its number, which must exist.
    ///
    /// # Safety
    /// While the manifold is in use no other thread may take a manifold of the same contact.
    #[inline(always)]
    #[expect(clippy::mut_from_ref, reason = "that is what it is for")]
    pub(crate) unsafe fn manifold(&self, id: u32, index: u32) -> &mut Manifold {
        // SAFETY: by the contract the contact and its manifolds in the side pool are this caller's alone.
        unsafe {
            let contact = self.contacts.one(id as usize);
            match index {
                0 => &mut contact.manifold,
                _ => &mut self.extra.one(contact.extra as usize)[index as usize - 1],
            }
        }
    }

    /// As [`manifold`](Self::manifold), at the end of a step. Also returns whether the present separations
    /// must be stored, because the next update may skip the contact.
    ///
    /// # Safety
    /// As [`manifold`](Self::manifold).
    #[inline(always)]
    #[expect(clippy::mut_from_ref, reason = "that is what it is for")]
    pub(crate) unsafe fn at_end(&self, id: u32, index: u32) -> (&mut Manifold, bool) {
        // SAFETY: by the contract the contact and its manifolds in the side pool are this caller's alone.
        unsafe {
            let contact = self.contacts.one(id as usize);
            let may_be_calm = contact.may_be_calm();
            contact.flags.set(ContactFlags::CALM, may_be_calm);
            (self.manifold(id, index), may_be_calm)
        }
    }
}

/// Whether the solver can take a manifold.
fn is_usable(manifold: &Manifold, surface: &ManifoldSurface) -> bool {
    let is_point = |p: &ManifoldPoint| {
        p.anchor.is_finite() && p.separation.is_finite() && p.impulse.is_finite() && p.impulse >= 0.0
    };
    manifold.count > 0
        && (manifold.normal.length() - 1.0).abs() < 1.0e-3
        && manifold.points().iter().all(is_point)
        && surface.friction >= 0.0
        && surface.friction.is_finite()
        && surface.restitution >= 0.0
        && surface.restitution.is_finite()
        && surface.velocity.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Vector, WorldPose};
    use crate::shape::{Ball, Shape};
    use crate::table::{BodyTable, ColliderDef};

    /// A manifold with one point on a normal of length `length`.
    fn manifold(length: f32) -> (Manifold, ManifoldSurface) {
        let mut m =
            Manifold { normal: Vector { x: length, ..Vector::ZERO }, count: 1, ..Manifold::default() };
        m.points[0] = ManifoldPoint { separation: -0.01, ..ManifoldPoint::default() };
        (m, ManifoldSurface { friction: 0.5, ..ManifoldSurface::default() })
    }

    /// A table with one contact of two colliders. `touched` is its state before the last update, `touches`
    /// its present state.
    fn table(touched: bool, touches: bool) -> (ContactTable, BitSet) {
        let (mut bodies, mut colliders) = (BodyTable::default(), ColliderTable::default());
        for _ in 0..2 {
            let def = ColliderDef::new(Shape::Ball(Ball { radius: 1.0 }), NONE);
            colliders.add(def, WorldPose::IDENTITY, &mut bodies);
        }
        let mut table = ContactTable::default();
        let mut contact = Contact::new([0, 1], [NONE; 2], ContactFlags::default());
        contact.flags.set(ContactFlags::TOUCHING, touches);
        contact.flags.set(ContactFlags::FROZEN, true);
        let id = table.add(contact, &mut colliders);
        let mut changed = BitSet::new();
        if touched != touches {
            changed.insert(id);
        }
        (table, changed)
    }

    #[test]
    fn a_change_begins_and_ends_what_it_leaves() {
        for (touched, keeps, is_change) in
            [(false, false, false), (false, true, true), (true, false, true), (true, true, false)]
        {
            let (mut table, mut changed) = table(touched, true);
            table.change(0, keeps.then(|| manifold(1.0)).into_iter(), &mut changed);
            assert_eq!(changed.contains(0), is_change, "touched before: {touched}, kept: {keeps}");
            assert_eq!(table.get(0).flags.has(ContactFlags::TOUCHING), keeps);
            assert!(!table.get(0).flags.has(ContactFlags::FROZEN), "it would be recycled");
            assert_eq!(table.changed_surface(0, 0).is_some(), keeps);
        }
    }

    #[test]
    fn manifolds_that_cannot_be_solved_are_left_out() {
        let (mut table, mut changed) = table(false, true);
        let all = [manifold(0.0), manifold(1.0), manifold(f32::NAN), manifold(1.0)];
        table.change(0, all.into_iter(), &mut changed);
        let contact = table.get(0);
        assert_eq!((contact.manifold.count, table.extra_of(contact).len()), (1, 1));
        assert!(table.changed_surface(0, 1).is_some() && table.changed_surface(0, 2).is_none());
    }
}
