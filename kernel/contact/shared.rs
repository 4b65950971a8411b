//! What a team does to the contacts together.
#![expect(unsafe_code, reason = "contacts are changed by several threads, each its own")]

use super::phase::{ManifoldSource, NarrowPhase};
use super::record::{Contact, ContactFlags, Manifold};
use super::table::{ContactTable, PointCount, Stored};
use super::update::{Begun, Scratch};
use crate::data::{BitSet, Parts};
use crate::table::{BodyKind, BodyTable, NONE};
use crate::team::Team;

/// How many contacts are updated at a stretch, in words of 64 ids: recycled ones take some microseconds.
const BLOCK: usize = 2;

/// So many contacts ahead records are brought near.
const AHEAD: usize = 4;

impl ContactTable {
    /// Updates all awake contacts; `scratches` is kept between steps. `changed` receives those that began or
    /// ended to touch or whose boxes came apart.
    pub fn update<S: ManifoldSource>(
        &mut self,
        phase: &NarrowPhase<S>,
        team: &Team,
        scratches: &mut Vec<Scratch<S::Workspace>>,
        changed: &mut BitSet,
    ) {
        scratches.iter_mut().for_each(Scratch::clear);
        if scratches.len() < team.members() {
            scratches.resize_with(team.members(), Scratch::default);
        }
        self.find_crowded(phase.bodies);
        let Self { contacts, points, active, extra, .. } = self;
        let crowded = self.any_deep.then_some(&self.crowded);
        let (contacts, points) = (Parts::of(contacts), Parts::of(points));
        let of_members = Parts::of(scratches);
        team.run(active.blocks(BLOCK), |block, member| {
            let mut ids = [0; 64 * BLOCK];
            let mut count = 0;
            for id in active.iter_block(BLOCK, block) {
                ids[count] = id;
                count += 1;
            }
            let ids = &ids[..count];
            // SAFETY: no two blocks run at once with the same member.
            let scratch = unsafe { of_members.one(member) };
            // Whoever waited when something panicked is not of this block.
            scratch.group.clear();
            ids[..AHEAD.min(ids.len())].iter().for_each(|id| contacts.prefetch(*id));
            for (i, &id) in ids.iter().enumerate() {
                if let Some(next) = ids.get(i + AHEAD) {
                    contacts.prefetch(*next);
                }
                // SAFETY: an id is in one block, once.
                let (contact, count) = unsafe { (contacts.one(id as usize), points.one(id as usize)) };
                match phase.begin(id, contact, &mut scratch.group) {
                    Begun::Apart => scratch.part(id, contact),
                    Begun::Asked => {}
                    Begun::Stale => scratch.renew(id, contact, count, extra, crowded, phase),
                }
                if scratch.group.is_full() {
                    // SAFETY: all that wait are of this block, and those above are in use no more.
                    unsafe { scratch.settle(&contacts, &points, extra, crowded, phase) };
                }
            }
            // SAFETY: as above.
            unsafe { scratch.settle(&contacts, &points, extra, crowded, phase) };
        });
        self.any_deep = false;
        for scratch in &*scratches {
            self.any_deep |= scratch.any_deep;
            for id in &scratch.changed {
                changed.insert(*id);
            }
        }
        self.store_all(scratches);
    }

    /// Stores the manifolds after the first that the members found. Places in the side pool are taken in the order of
    /// contacts, not of members, so that equal steps give equal tables.
    fn store_all<W>(&mut self, scratches: &[Scratch<W>]) {
        let mut stored = core::mem::take(&mut self.stored);
        for (member, scratch) in scratches.iter().enumerate() {
            let mut start = 0;
            for &(contact, count) in &scratch.stored {
                stored.push(Stored { contact, member, range: start..start + count });
                start += count;
            }
        }
        stored.sort_unstable_by_key(|stored| stored.contact);
        for Stored { contact, member, range } in stored.drain(..) {
            self.store_extra(contact, &scratches[member].pool[range]);
        }
        self.stored = stored;
    }

    /// Finds the dynamic bodies that overlap others deeply.
    fn find_crowded(&mut self, bodies: &BodyTable) {
        self.crowded.clear();
        if !self.any_deep {
            return;
        }
        for id in self.active.iter() {
            let contact = &self.contacts[id as usize];
            if contact.flags.has(ContactFlags::DEEP) {
                let dynamic = |body: &u32| *body != NONE && bodies[*body].kind == BodyKind::Dynamic;
                contact.bodies.into_iter().filter(dynamic).for_each(|body| _ = self.crowded.insert(body));
            }
        }
    }

    /// The manifolds, changed by several threads at once.
    pub(crate) fn manifolds_view(&mut self) -> ManifoldsView<'_> {
        ManifoldsView { contacts: Parts::of(&mut self.contacts), extra: Parts::of(&mut self.extra) }
    }
}

impl<W> Scratch<W> {
    /// Forgets what the table was to be told.
    fn clear(&mut self) {
        self.changed.clear();
        self.stored.clear();
        self.pool.clear();
        self.any_deep = false;
    }

    /// Updates the contacts that wait in the group, and empties it.
    ///
    /// # Safety
    /// Nobody else may have one of these contacts, nor its count.
    #[inline(always)]
    unsafe fn settle<S: ManifoldSource<Workspace = W>>(
        &mut self,
        contacts: &Parts<Contact>,
        points: &Parts<PointCount>,
        extra: &[Vec<Manifold>],
        crowded: Option<&BitSet>,
        phase: &NarrowPhase<S>,
    ) {
        phase.answer(&mut self.group);
        for place in 0..self.group.ids().len() {
            let id = self.group.ids()[place];
            // SAFETY: by the contract nobody else has it; the one before is in use no more.
            let (contact, count) = unsafe { (contacts.one(id as usize), points.one(id as usize)) };
            if self.group.apply(place, contact) {
                phase.follow(contact);
                self.any_deep |= contact.flags.has(ContactFlags::DEEP);
            } else {
                self.renew(id, contact, count, extra, crowded, phase);
            }
        }
        self.group.clear();
    }

    /// Notes that the boxes of a contact came apart.
    fn part(&mut self, id: u32, contact: &mut Contact) {
        contact.flags.set(ContactFlags::APART, true);
        self.changed.push(id);
        self.any_deep |= contact.flags.has(ContactFlags::DEEP);
    }

    /// Computes the manifolds of a contact anew, and notes what only the table can do.
    fn renew<S: ManifoldSource<Workspace = W>>(
        &mut self,
        id: u32,
        contact: &mut Contact,
        count: &mut PointCount,
        extra: &[Vec<Manifold>],
        crowded: Option<&BitSet>,
        phase: &NarrowPhase<S>,
    ) {
        let is_among = |crowd: &BitSet| contact.bodies.iter().any(|b| *b != NONE && crowd.contains(*b));
        let is_crowded = crowded.is_some_and(is_among);
        let touched = contact.flags.has(ContactFlags::TOUCHING);
        let extra: &[Manifold] = match contact.extra {
            NONE => &[],
            slot => &extra[slot as usize][..usize::from(contact.extra_count)],
        };
        phase.renew(contact, extra, is_crowded, self);
        if touched != contact.flags.has(ContactFlags::TOUCHING) {
            self.changed.push(id);
        }
        if contact.extra != NONE || !self.extra.is_empty() {
            self.stored.push((id, self.extra.len()));
            self.pool.extend_from_slice(&self.extra);
        }
        self.any_deep |= contact.flags.has(ContactFlags::DEEP);
        // Counts of contacts of different blocks share cache lines, so they are left alone where they may be.
        let now = PointCount::of(contact);
        if *count != now {
            *count = now;
        }
    }
}

/// The manifolds of all contacts, changed by several threads at once.
pub(crate) struct ManifoldsView<'a> {
    contacts: Parts<'a, Contact>,
    extra: Parts<'a, Vec<Manifold>>,
}

impl ManifoldsView<'_> {
    /// Has contacts brought near that are needed soon; those that do not exist are left out.
    #[inline(always)]
    pub(crate) fn prefetch(&self, ids: &[u32]) {
        ids.iter().for_each(|id| self.contacts.prefetch(*id));
    }

    /// A contact's manifold by its number, which must exist.
    ///
    /// # Safety
    /// While it is in use nobody may take a manifold of the same contact.
    #[inline(always)]
    #[expect(clippy::mut_from_ref, reason = "that is what it is for")]
    pub(crate) unsafe fn manifold(&self, id: u32, index: u32) -> &mut Manifold {
        // SAFETY: by the contract nobody else has the contact, nor its manifolds in the side pool.
        unsafe {
            let contact = self.contacts.one(id as usize);
            match index {
                0 => &mut contact.manifold,
                _ => &mut self.extra.one(contact.extra as usize)[index as usize - 1],
            }
        }
    }
}
