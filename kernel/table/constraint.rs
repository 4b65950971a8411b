//! Constraints other than contacts, by id: the bodies of each, and the constraints of each body.

use super::NONE;
use crate::data::IdPool;
use crate::graph::ColorSlot;

/// Data common to constraints of all kinds. Data of one kind is in a table of its own, by the same id.
#[derive(Clone, Copy, Debug)]
pub struct Constraint {
    /// The bodies.
    pub bodies: [u32; 2],
    /// Place in the colour graph; `None` if all bodies of the constraint sleep or are immovable.
    pub slot: Option<ColorSlot>,
    /// Next and previous constraint of the same body, for each side, as `constraint << 1 | side`.
    next: [u32; 2],
    previous: [u32; 2],
}

/// All constraints of one kind.
///
/// Decision: each kind has its own lists of a body's constraints, outside of the body. Most bodies have no
/// constraint and pay nothing.
#[derive(Clone, Debug, Default)]
pub struct ConstraintTable {
    ids: IdPool,
    constraints: Vec<Constraint>,
    /// First constraint of each body, as in [`Constraint`]. Shorter than the number of bodies if the last
    /// bodies have none.
    first: Vec<u32>,
}

impl ConstraintTable {
    /// The number of constraints.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are no constraints.
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

    /// Adds a constraint between two different bodies. It gets the lowest free id.
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

    /// Removes a constraint from the lists of its bodies, and frees its id.
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

    /// Checks the lists of bodies.
    ///
    /// # Panics
    /// If an invariant does not hold; the message names it.
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
