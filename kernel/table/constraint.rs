//! Constraints that are not contacts, by id: between which bodies, and which a body has.

use super::NONE;
use crate::data::IdPool;
use crate::graph::ColorSlot;

/// What constraints of all kinds have in common. What is special to a kind is in a table of its own, by the same id.
#[derive(Clone, Copy, Debug)]
pub struct Constraint {
    /// The bodies.
    pub bodies: [u32; 2],
    /// The place among its colour's constraints; `None` unless it can push a body that is awake.
    pub slot: Option<ColorSlot>,
    /// Next and previous constraint of the same body, for each side, as `constraint << 1 | side`.
    next: [u32; 2],
    previous: [u32; 2],
}

/// All constraints of one kind.
///
/// Decision: a body's constraints are lists of their own for each kind, beside the bodies. A body without constraints,
/// which most are, pays nothing.
#[derive(Clone, Debug, Default)]
pub struct ConstraintTable {
    ids: IdPool,
    constraints: Vec<Constraint>,
    /// The first constraint of each body, as in [`Constraint`]; shorter where the last bodies have none.
    first: Vec<u32>,
}

impl ConstraintTable {
    /// How many constraints there are.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether an id is in use.
    pub fn is_live(&self, id: u32) -> bool {
        self.ids.is_live(id)
    }

    /// A constraint.
    ///
    /// # Panics
    /// If the id was never in use.
    pub fn get(&self, id: u32) -> &Constraint {
        debug_assert!(self.is_live(id), "constraint {id} is in use");
        &self.constraints[id as usize]
    }

    /// All constraints, by id.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &Constraint)> {
        self.ids.iter().map(|id| (id, self.get(id)))
    }

    /// The constraints of a body, the last added first.
    pub fn of_body(&self, body: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.first.get(body as usize).copied().unwrap_or(NONE);
        core::iter::successors((first != NONE).then_some(first), |edge| {
            let next = self.constraints[(edge >> 1) as usize].next[(edge & 1) as usize];
            (next != NONE).then_some(next)
        })
        .map(|edge| edge >> 1)
    }

    pub(crate) fn set_slot(&mut self, id: u32, slot: Option<ColorSlot>) {
        debug_assert!(self.is_live(id), "constraint {id} is in use");
        self.constraints[id as usize].slot = slot;
    }

    /// Adds a constraint between two different bodies. The lowest free id is its own.
    pub(crate) fn add(&mut self, bodies: [u32; 2]) -> u32 {
        debug_assert!(bodies[0] != bodies[1], "a constraint has two bodies");
        self.ids.recycle();
        let id = self.ids.allocate();
        let constraint = Constraint { bodies, slot: None, next: [NONE; 2], previous: [NONE; 2] };
        match self.constraints.get_mut(id as usize) {
            Some(place) => *place = constraint,
            None => self.constraints.push(constraint),
        }
        for (side, body) in bodies.into_iter().enumerate() {
            if self.first.len() <= body as usize {
                self.first.resize(body as usize + 1, NONE);
            }
            let edge = id << 1 | side as u32;
            let first = core::mem::replace(&mut self.first[body as usize], edge);
            self.constraints[id as usize].next[side] = first;
            if first != NONE {
                self.constraints[(first >> 1) as usize].previous[(first & 1) as usize] = edge;
            }
        }
        id
    }

    /// Takes a constraint out of its bodies' lists, and frees its id.
    pub(crate) fn remove(&mut self, id: u32) {
        let Constraint { bodies, next, previous, slot } = *self.get(id);
        debug_assert!(slot.is_none(), "a constraint gives back its colour before it is removed");
        for side in 0..2 {
            match previous[side] {
                NONE => self.first[bodies[side] as usize] = next[side],
                edge => self.constraints[(edge >> 1) as usize].next[(edge & 1) as usize] = next[side],
            }
            if next[side] != NONE {
                let edge = next[side];
                self.constraints[(edge >> 1) as usize].previous[(edge & 1) as usize] = previous[side];
            }
        }
        self.ids.free(id);
    }

    /// Checks that bodies list their constraints.
    ///
    /// # Panics
    /// With the invariant that does not hold.
    pub fn validate(&self) {
        let mut listed = 0;
        for body in 0..self.first.len() as u32 {
            for id in self.of_body(body) {
                assert!(self.is_live(id) && self.get(id).bodies.contains(&body), "lists hold their own");
                listed += 1;
            }
        }
        assert_eq!(listed, 2 * self.len(), "bodies list their constraints");
    }
}
