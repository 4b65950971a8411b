//! The contact manager: it alone creates and destroys contacts and other constraints, and changes colours,
//! islands and sleep.
//!
//! Invariants: a contact is active while one of its bodies is awake; a constraint has a colour while it is
//! solved and one of its dynamic bodies is awake; its two dynamic bodies share an island while it is solved;
//! the bodies of an island are awake or asleep together.

use super::record::{Contact, ContactFlags};
use super::table::ContactTable;
use crate::data::BitSet;
use crate::graph::{ColorGraph, ConstraintId, ConstraintKind, IslandId, Islands};
use crate::shape::Shape;
use crate::table::{BodyKind, BodyTable, ColliderTable, FacetMaterials, Material, NONE};
use std::sync::Arc;

/// A change of a contact, for reports to the app.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The shapes began to touch: the first point appeared.
    Began,
    /// The shapes no longer touch: the last point disappeared.
    Ended,
}

/// All tables that a change of contacts or other constraints touches.
pub struct ContactManager<'a> {
    /// The bodies.
    pub bodies: &'a mut BodyTable,
    /// The colliders.
    pub colliders: &'a mut ColliderTable,
    /// The contacts.
    pub contacts: &'a mut ContactTable,
    /// The colours of solved constraints.
    pub colors: &'a mut ColorGraph,
    /// The islands of dynamic bodies; without them every body wakes alone and none is put to sleep.
    pub islands: Option<&'a mut Islands>,
}

impl ContactManager<'_> {
    /// Adds the contact of a pair that has none. Its colliders must be live and of different bodies.
    pub fn create(&mut self, a: u32, b: u32) -> u32 {
        self.create_with(a, b, ContactFlags::default())
    }

    /// As [`create`](Self::create), with additional bits such as [`ContactFlags::QUIET`].
    pub fn create_with(&mut self, a: u32, b: u32, extra: ContactFlags) -> u32 {
        let colliders = [a.min(b), a.max(b)];
        let bodies = colliders.map(|c| self.colliders[c].def.body);
        let flags = self.flags(colliders, bodies).union(extra);
        let surface = self.mixed(colliders);
        let contact = Contact { surface, ..Contact::new(colliders, bodies, flags) };
        let id = self.contacts.add(contact, self.colliders);
        self.refresh(ConstraintId::contact(id));
        id
    }

    /// Applies the changes found by the narrow phase, in the order of ids, and restarts the sleep timers of
    /// woken islands. Call it in every step, before bodies are finished. `report` is called for each change.
    pub fn apply(&mut self, changed: &BitSet, mut report: impl FnMut(u32, &Contact, Status)) {
        for id in changed.iter() {
            if !self.contacts.is_live(id) {
                continue;
            }
            let contact = self.contacts.get(id);
            let touching = contact.flags.has(ContactFlags::TOUCHING);
            if contact.flags.has(ContactFlags::SEPARATED) {
                if touching {
                    report(id, contact, Status::Ended);
                }
                self.detach(ConstraintId::contact(id));
                self.contacts.remove(id, self.colliders);
            } else if touching {
                report(id, contact, Status::Began);
                self.attach(ConstraintId::contact(id));
            } else {
                report(id, contact, Status::Ended);
                self.detach(ConstraintId::contact(id));
            }
        }
        if let Some(islands) = &mut self.islands {
            islands.drain_woken(|body| self.bodies[body].sleep_timer = 0.0);
        }
        self.contacts.count_step();
        if self.contacts.gives_back {
            self.colors.shrink();
            self.islands.iter_mut().for_each(|islands| islands.shrink());
        }
        for id in core::mem::take(&mut self.contacts.visited) {
            if self.contacts.is_live(id) {
                self.refresh(ConstraintId::contact(id));
            }
        }
    }

    /// Has the next narrow phase update the inert contacts of a collider although both bodies are at rest,
    /// after the collider was moved or added. Other contacts wait until a body wakes.
    pub fn visit_of_collider(&mut self, collider: u32) {
        for id in self.contacts_of_collider(collider) {
            self.visit(id);
        }
    }

    /// Has the next narrow phase update an inert contact although both bodies are at rest.
    pub fn visit(&mut self, id: u32) {
        if self.contacts.get(id).is_inert() && !self.contacts.is_active(id) {
            self.contacts.activate(id);
            self.contacts.visited.push(id);
        }
    }

    /// Removes a contact. Wakes its bodies if it was solved.
    pub fn destroy(&mut self, id: u32) {
        self.wake_if_solved(ConstraintId::contact(id));
        self.detach(ConstraintId::contact(id));
        self.contacts.remove(id, self.colliders);
    }

    /// Removes all contacts of a collider.
    pub fn destroy_of_collider(&mut self, collider: u32) {
        while self.colliders[collider].first_contact != NONE {
            self.destroy(self.colliders[collider].first_contact >> 1);
        }
    }

    /// Enters a new body in the islands.
    pub fn enter(&mut self, body: u32) {
        if let Some(islands) = &mut self.islands
            && self.bodies[body].kind == BodyKind::Dynamic
        {
            let island = islands.add_body(body);
            islands.set_asleep(island, !self.bodies[body].awake);
        }
    }

    /// Removes a body without colliders, with its constraints. Wakes the bodies of solved constraints.
    pub fn leave(&mut self, body: u32) {
        self.disconnect_body(body);
        self.leave_island(body);
        self.bodies.remove(body);
    }

    /// Changes the kind of a body. Its contacts and other constraints stay, in new colours and islands. The
    /// body wakes, with the bodies that it touches or is connected to.
    pub fn retype(&mut self, body: u32, kind: BodyKind) {
        let old = self.bodies[body].kind;
        if old == kind {
            return;
        }
        self.wake_body(body);
        let constraints = self.constraints_of_body(body);
        for constraint in &constraints {
            self.wake_bodies(self.tie(*constraint).bodies);
            self.detach(*constraint);
        }
        self.leave_island(body);
        self.bodies.set_kind(body, kind);
        let colliders: Vec<u32> = self.colliders.of_body(body, self.bodies).collect();
        colliders.into_iter().for_each(|collider| self.colliders.update_reach(collider, self.bodies));
        self.enter(body);
        for constraint in constraints {
            if let ConstraintId { kind: ConstraintKind::Contact, id } = constraint {
                self.contacts.get_mut(id).flags = self.fresh_flags(id);
            }
            self.refresh(constraint);
            self.attach(constraint);
        }
    }

    /// Updates the flags of a collider's contacts after the collider was redefined in place. Their manifolds
    /// are recomputed; colour and island change only if a contact begins or ceases to respond.
    pub fn reflag_of_collider(&mut self, collider: u32) {
        for id in self.contacts_of_collider(collider) {
            let flags = self.fresh_flags(id);
            let contact = self.contacts.get_mut(id);
            let (was_solved, inert) = (contact.is_solved(), contact.is_inert());
            contact.flags = flags;
            if inert == contact.is_inert() {
                continue;
            }
            if was_solved {
                self.detach(ConstraintId::contact(id));
            }
            self.attach(ConstraintId::contact(id));
        }
        self.mix_of_collider(collider);
    }

    /// Wakes the island of a dynamic body, or a kinematic body alone. Does nothing for static bodies and
    /// [`NONE`].
    pub fn wake_body(&mut self, body: u32) {
        if body == NONE {
            return;
        }
        match self.bodies[body].kind {
            BodyKind::Static => {}
            BodyKind::Kinematic => self.set_kinematic_awake(body, true),
            BodyKind::Dynamic => {
                self.bodies[body].sleep_timer = 0.0;
                match self.island_of(body) {
                    Some(island) => self.wake_island(island),
                    None if self.bodies[body].awake => {}
                    None => self.set_awake(&[body], true),
                }
            }
        }
    }

    /// Wakes both bodies of a constraint.
    pub(super) fn wake_bodies(&mut self, bodies: [u32; 2]) {
        bodies.into_iter().for_each(|body| self.wake_body(body));
    }

    /// The island of a body, if it is in one.
    pub fn island_of(&self, body: u32) -> Option<IslandId> {
        self.islands.as_ref().and_then(|islands| islands.island_of(body))
    }

    fn leave_island(&mut self, body: u32) {
        if let Some(islands) = &mut self.islands
            && self.bodies[body].kind == BodyKind::Dynamic
        {
            islands.remove_body(body);
        }
    }

    /// The sleeping body of a contact whose other body does not move either, because it is static, or
    /// kinematic and at rest. The narrow phase skips such a contact until the sleeping body wakes.
    pub fn unseen_sleeper(&self, id: u32) -> Option<u32> {
        let contact = self.contacts.get(id);
        if contact.is_inert() || contact.bodies.iter().any(|b| self.is_awake(*b)) {
            return None;
        }
        match self.movable(contact.bodies) {
            [Some(_), Some(_)] => None,
            [a, b] => a.or(b),
        }
    }

    /// Wakes the bodies that a body touches or is connected to, as after it was moved by hand. Also wakes
    /// nearby bodies whose contact is [unseen](Self::unseen_sleeper).
    pub fn wake_touching(&mut self, body: u32) {
        for id in self.contacts_of_body(body) {
            if let Some(sleeper) = self.unseen_sleeper(id).filter(|sleeper| *sleeper != body) {
                self.wake_body(sleeper);
            }
        }
        for constraint in self.constraints_of_body(body) {
            self.wake_if_solved(constraint);
        }
    }

    /// Wakes a body and the bodies that it touches, as after one of its colliders changed. Does nothing for
    /// [`NONE`].
    pub fn wake_with_touching(&mut self, body: u32) {
        if body != NONE {
            self.wake_body(body);
            self.wake_touching(body);
        }
    }

    /// Wakes all bodies of an island and restarts their sleep timers. For an awake island the timers restart
    /// in the next [`apply`](Self::apply), so that many calls in one step cost one walk over the island.
    pub fn wake_island(&mut self, island: IslandId) {
        let Some(islands) = &mut self.islands else { return };
        if !islands.is_asleep(island) {
            return islands.mark_woken(island);
        }
        for &body in islands.bodies(island) {
            self.bodies[body].sleep_timer = 0.0;
        }
        self.set_island_awake(island, true);
    }

    /// Whether a moving kinematic body is connected to a body of the island. Then the island must not sleep,
    /// however slowly it is carried, or its support would move away without it.
    pub fn is_carried(&self, island: IslandId) -> bool {
        self.islands.as_ref().is_some_and(|islands| islands.carriers(island) > 0)
    }

    /// Puts all bodies of an island to sleep: their contacts keep their impulses, but leave the colours.
    pub fn sleep_island(&mut self, island: IslandId) {
        if self.islands.as_ref().is_some_and(|islands| !islands.is_asleep(island)) {
            self.set_island_awake(island, false);
        }
    }

    fn set_island_awake(&mut self, island: IslandId, awake: bool) {
        let Some(islands) = &mut self.islands else { return };
        islands.set_asleep(island, !awake);
        let bodies = islands.bodies(island).to_vec();
        self.set_awake(&bodies, awake);
    }

    fn set_awake(&mut self, bodies: &[u32], awake: bool) {
        let mut constraints = Vec::new();
        for &body in bodies {
            self.bodies.set_awake(body, awake);
            constraints.extend(self.constraints_of_body(body));
        }
        // Colours depend on the order in which constraints enter them.
        constraints.sort_unstable();
        constraints.dedup();
        for constraint in constraints {
            self.refresh(constraint);
        }
    }

    /// Wakes a kinematic body and the bodies that it touches, or puts it to rest.
    pub fn set_kinematic_awake(&mut self, body: u32, awake: bool) {
        if self.bodies[body].kind != BodyKind::Kinematic || self.bodies[body].awake == awake {
            return;
        }
        self.bodies.set_awake(body, awake);
        for constraint in self.constraints_of_body(body) {
            if awake {
                self.wake_if_solved(constraint);
            }
            self.refresh(constraint);
        }
    }

    /// The contacts of a collider.
    fn contacts_of_collider(&self, collider: u32) -> Vec<u32> {
        self.contacts.of_collider(collider, self.colliders).collect()
    }

    /// The contacts of a body's colliders, ascending.
    pub(super) fn contacts_of_body(&self, body: u32) -> Vec<u32> {
        let mut ids = Vec::new();
        for collider in self.colliders.of_body(body, self.bodies) {
            ids.extend(self.contacts.of_collider(collider, self.colliders));
        }
        ids.sort_unstable();
        ids
    }

    /// Replaces the material of a collider.
    pub fn set_material(&mut self, collider: u32, material: Material) {
        if core::mem::replace(&mut self.colliders[collider].def.material, material) != material {
            self.mix_of_collider(collider);
        }
    }

    /// Replaces the facet materials of a collider. Its contacts are recomputed.
    pub fn set_facets(&mut self, collider: u32, facets: Option<Arc<FacetMaterials>>) {
        if self.colliders[collider].def.facets != facets {
            self.colliders[collider].def.facets = facets;
            self.colliders.update_reach(collider, self.bodies);
        }
    }

    /// Updates the mixed coefficients of a collider's contacts.
    fn mix_of_collider(&mut self, collider: u32) {
        for id in self.contacts_of_collider(collider) {
            self.contacts.get_mut(id).surface = self.mixed(self.contacts.get(id).colliders);
        }
    }

    /// The mixed friction and restitution of two colliders.
    fn mixed(&self, colliders: [u32; 2]) -> [f32; 2] {
        let [a, b] = colliders.map(|c| &self.colliders[c].def.material);
        [a.friction.mix(b.friction), a.restitution.mix(b.restitution)]
    }

    /// The flags of a pair, from its colliders and bodies.
    fn flags(&self, colliders: [u32; 2], bodies: [u32; 2]) -> ContactFlags {
        let defs = colliders.map(|c| &self.colliders[c].def);
        let mut flags = ContactFlags::default();
        flags.set(ContactFlags::SENSOR, defs.iter().any(|d| d.flags.sensor));
        let is_foreign = defs.iter().any(|d| matches!(d.shape, Shape::Foreign(_)));
        let is_composite = defs.iter().any(|d| matches!(d.shape, Shape::Composite(_)));
        flags.set(ContactFlags::FOREIGN, is_foreign);
        flags.set(ContactFlags::COMPOSITE, is_composite && !is_foreign);
        flags.set(ContactFlags::HULL, defs.iter().any(|d| matches!(d.shape, Shape::Hull(_))));
        let is_movable = !bodies.contains(&NONE) && self.movable(bodies) != [None; 2];
        flags.set(ContactFlags::IMMOVABLE, !is_movable);
        flags
    }

    /// The present flags of a contact's pair. `TOUCHING` and `QUIET` stay; the manifold will be recomputed.
    fn fresh_flags(&self, id: u32) -> ContactFlags {
        let contact = self.contacts.get(id);
        let mut flags = self.flags(contact.colliders, contact.bodies);
        for kept in [ContactFlags::TOUCHING, ContactFlags::QUIET] {
            flags.set(kept, contact.flags.has(kept));
        }
        flags
    }

    /// Checks that colours, islands and sleep agree with every contact and body.
    ///
    /// # Panics
    ///
    /// If an invariant does not hold; the message names it.
    pub fn validate(&self) {
        self.contacts.validate(self.colliders);
        self.colors.validate(|kind, id| {
            let tie = self.tie(ConstraintId { kind, id });
            (tie.slot.expect("a coloured constraint knows its slot"), self.movable(tie.bodies))
        });
        for (id, contact) in self.contacts.iter() {
            assert_eq!(contact.surface, self.mixed(contact.colliders), "contact {id} knows its surfaces");
            let awake = contact.bodies.iter().any(|b| self.is_awake(*b));
            assert_eq!(
                self.contacts.is_active(id),
                awake,
                "contact {id} is active exactly if a body is awake"
            );
        }
        let others = ConstraintKind::ALL.into_iter().flat_map(|kind| {
            let constraints = self.bodies.constraints(kind);
            constraints.validate();
            constraints.iter().map(move |(id, _)| ConstraintId { kind, id })
        });
        let (mut colored, mut carrying) = (0, 0);
        for constraint in self.contacts.iter().map(|(id, _)| ConstraintId::contact(id)).chain(others) {
            let [has_color, is_carried] = self.validate_tie(constraint);
            colored += usize::from(has_color);
            carrying += u32::from(is_carried);
        }
        assert_eq!(self.colors.len(), colored, "only constraints have colours");
        if let Some(islands) = &self.islands {
            islands.validate();
            let carriers: u32 = islands.islands().map(|island| islands.carriers(island)).sum();
            assert_eq!(carriers, carrying, "islands count the constraints that carry them");
            for island in islands.islands() {
                for body in islands.bodies(island) {
                    let awake = self.bodies[*body].awake;
                    assert_eq!(awake, !islands.is_asleep(island), "an island sleeps as one");
                }
            }
        }
    }
}
