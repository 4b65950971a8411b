//! Common part of contacts and other constraints between two bodies: colours, islands and waking.

use super::manager::ContactManager;
use crate::graph::{ColorSlot, ConstraintId, ConstraintKind, LinkId};
use crate::table::{BodyKind, NONE};

/// The part of a constraint that colours, islands and sleep need.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tie {
    pub(super) bodies: [u32; 2],
    /// Whether it acts while one of its dynamic bodies is awake.
    pub(super) is_solved: bool,
    pub(super) slot: Option<ColorSlot>,
}

impl ContactManager<'_> {
    /// Connects two live, different bodies by a constraint of a kind. Both wake, and share an island from now
    /// on. Returns its id.
    pub(crate) fn connect(&mut self, kind: ConstraintKind, bodies: [u32; 2]) -> u32 {
        debug_assert!(kind != ConstraintKind::Contact, "contacts are created from colliders");
        self.wake_bodies(bodies);
        let id = self.bodies.constraints_mut(kind).add(bodies);
        self.attach(ConstraintId { kind, id });
        id
    }

    /// Removes a constraint that is not a contact. Wakes its bodies if it was solved.
    pub(crate) fn disconnect(&mut self, kind: ConstraintKind, id: u32) {
        let constraint = ConstraintId { kind, id };
        self.wake_if_solved(constraint);
        self.detach(constraint);
        self.bodies.constraints_mut(kind).remove(id);
    }

    /// Removes all constraints of a body except its contacts.
    pub(super) fn disconnect_body(&mut self, body: u32) {
        for constraint in self.constraints_of_body(body) {
            if constraint.kind != ConstraintKind::Contact {
                self.disconnect(constraint.kind, constraint.id);
            }
        }
    }

    /// The constraints of a body, contacts among them, ascending.
    pub(super) fn constraints_of_body(&self, body: u32) -> Vec<ConstraintId> {
        let mut all: Vec<_> = self.contacts_of_body(body).into_iter().map(ConstraintId::contact).collect();
        for kind in ConstraintKind::ALL {
            let start = all.len();
            all.extend(self.bodies.constraints(kind).of_body(body).map(|id| ConstraintId { kind, id }));
            all[start..].sort_unstable();
        }
        all
    }

    pub(super) fn tie(&self, ConstraintId { kind, id }: ConstraintId) -> Tie {
        if kind == ConstraintKind::Contact {
            let contact = self.contacts.get(id);
            return Tie { bodies: contact.bodies, is_solved: contact.is_solved(), slot: contact.slot };
        }
        let constraint = self.bodies.constraints(kind).get(id);
        let is_solved = self.movable(constraint.bodies) != [None; 2];
        Tie { bodies: constraint.bodies, is_solved, slot: constraint.slot }
    }

    /// Wakes both bodies of a constraint that is solved.
    pub(super) fn wake_if_solved(&mut self, constraint: ConstraintId) {
        let tie = self.tie(constraint);
        if tie.is_solved {
            self.wake_bodies(tie.bodies);
        }
    }

    fn set_slot(&mut self, ConstraintId { kind, id }: ConstraintId, slot: Option<ColorSlot>) {
        match kind {
            ConstraintKind::Contact => self.contacts.get_mut(id).slot = slot,
            _ => self.bodies.constraints_mut(kind).set_slot(id, slot),
        }
    }

    /// The dynamic bodies, which occupy a colour.
    pub(super) fn movable(&self, bodies: [u32; 2]) -> [Option<u32>; 2] {
        bodies.map(|b| (b != NONE && self.bodies[b].kind == BodyKind::Dynamic).then_some(b))
    }

    pub(super) fn is_awake(&self, body: u32) -> bool {
        body != NONE && self.bodies[body].awake
    }

    /// The dynamic body of a solved constraint with a moving kinematic body.
    pub(super) fn carried(&self, tie: &Tie) -> Option<u32> {
        let moves = |body: u32| self.is_awake(body) && self.bodies[body].kind == BodyKind::Kinematic;
        if !tie.is_solved || !tie.bodies.into_iter().any(moves) {
            return None;
        }
        self.movable(tie.bodies).into_iter().flatten().next()
    }

    /// Puts a constraint into effect: wakes both sides, joins their islands, gives it a colour.
    pub(super) fn attach(&mut self, constraint: ConstraintId) {
        let tie = self.tie(constraint);
        if !tie.is_solved {
            return;
        }
        let [a, b] = self.movable(tie.bodies);
        for body in [a, b].into_iter().flatten() {
            // A pair at rest stays asleep.
            if tie.bodies.iter().any(|other| self.is_awake(*other)) && !self.bodies[body].awake {
                self.wake_body(body);
            }
        }
        if let (Some(a), Some(b), Some(islands)) = (a, b, &mut self.islands) {
            islands.link(LinkId::of(constraint), a, b);
        }
        self.refresh(constraint);
    }

    /// Takes a constraint out of its colour and island.
    pub(super) fn detach(&mut self, constraint: ConstraintId) {
        self.uncolor(constraint);
        if let Some(islands) = &mut self.islands {
            islands.unlink(LinkId::of(constraint));
        }
    }

    /// Gives a constraint a colour exactly while its state requires one. A contact also becomes active or
    /// inactive.
    pub(super) fn refresh(&mut self, constraint: ConstraintId) {
        let tie = self.tie(constraint);
        let movable = self.movable(tie.bodies);
        let is_colored = tie.is_solved && movable.iter().flatten().any(|b| self.is_awake(*b));
        let carried = self.carried(&tie);
        match (is_colored, tie.slot) {
            (true, None) => {
                let slot = self.colors.assign(constraint.kind, constraint.id, movable);
                self.set_slot(constraint, Some(slot));
            }
            (false, Some(_)) => self.uncolor(constraint),
            _ => {}
        }
        if let (Some(islands), [_, None] | [None, _]) = (&mut self.islands, movable) {
            match carried {
                Some(body) if !islands.is_linked(LinkId::of(constraint)) => {
                    islands.link_carrier(LinkId::of(constraint), body);
                }
                None => _ = islands.unlink(LinkId::of(constraint)),
                Some(_) => {}
            }
        }
        if constraint.kind == ConstraintKind::Contact {
            if tie.bodies.iter().any(|b| self.is_awake(*b)) {
                self.contacts.activate(constraint.id);
            } else {
                self.contacts.deactivate(constraint.id);
            }
        }
    }

    fn uncolor(&mut self, constraint: ConstraintId) {
        let tie = self.tie(constraint);
        let Some(slot) = tie.slot else { return };
        self.set_slot(constraint, None);
        if let Some(id) = self.colors.release(constraint.kind, slot, self.movable(tie.bodies)) {
            self.set_slot(ConstraintId { kind: constraint.kind, id }, Some(slot));
        }
    }

    /// Checks a constraint against colours and islands. Returns whether it has a colour, and whether a
    /// kinematic body that moves carries it.
    ///
    /// # Panics
    /// If an invariant does not hold; the message names it.
    pub(super) fn validate_tie(&self, constraint: ConstraintId) -> [bool; 2] {
        let tie = self.tie(constraint);
        let movable = self.movable(tie.bodies);
        let moving = movable.iter().flatten().any(|b| self.is_awake(*b));
        assert_eq!(tie.slot.is_some(), tie.is_solved && moving, "{constraint:?}'s colour");
        if let ([Some(a), Some(b)], Some(islands)) = (movable, &self.islands) {
            assert_eq!(islands.is_linked(LinkId::of(constraint)), tie.is_solved, "{constraint:?}'s link");
            if tie.is_solved {
                assert_eq!(islands.island_of(a), islands.island_of(b), "what is connected is in one island");
            }
        }
        [tie.slot.is_some(), self.carried(&tie).is_some()]
    }
}
