//! Loads that end: bodies whose contacts begin a step without impulses.
//!
//! A crate between a door and a wall that do not yield has no solution: with each sweep its contacts press more, up to some hundred
//! times the impulse that moves it. When the door opens, a sweep takes off no more than the mass times the speed of opening, so the
//! door drags the crate along for half a second.
//!
//! Decision: where a kinematic body leaves faster than a blow what it presses, the load is over at once, in all contacts that it
//! reached through bodies: their impulses balance, and the rest of them would throw a body. Bodies that impulses move give way
//! instead of jamming, so their loads are left to sweeps.

use super::input::RowInput;
use super::{BodyRows, SubstepParams};
use crate::contact::{Contact, Manifold};
use crate::data::BitSet;
use crate::math::{Angular, Vector, max, min};

/// The bodies whose load ended. Buffers are kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Released {
    /// In the order in which they were found.
    bodies: Vec<u32>,
    rows: BitSet,
}

impl Released {
    /// Whether the contact of two body rows begins without impulses.
    #[inline(always)]
    pub(super) fn concerns(&self, rows: [u32; 2]) -> bool {
        !self.bodies.is_empty() && rows.into_iter().any(|row| self.rows.contains(row))
    }

    /// Finds the bodies whose load ends with this step.
    pub(super) fn find(&mut self, input: &RowInput, bodies: &BodyRows, params: &SubstepParams) {
        self.bodies.clear();
        self.rows.clear();
        for body in input.bodies.awake_kinematic() {
            if velocity(bodies, input.row_of(body)) != (Vector::ZERO, Angular::ZERO) {
                self.reach(body, input, bodies, |contact, manifold, rows| {
                    is_pressed(manifold, rows, bodies, params)
                        && opening(contact, manifold, rows, bodies) > params.blow_speed
                });
            }
        }
        let mut next = 0;
        while let Some(body) = self.bodies.get(next) {
            self.reach(*body, input, bodies, |_, manifold, rows| is_pressed(manifold, rows, bodies, params));
            next += 1;
        }
    }

    /// Adds the dynamic bodies that have a manifold with a body for which `ends` holds.
    fn reach(
        &mut self,
        body: u32,
        input: &RowInput,
        bodies: &BodyRows,
        ends: impl Fn(&Contact, &Manifold, [u32; 2]) -> bool,
    ) {
        let RowInput { contacts, colliders, .. } = input;
        let of_body = colliders.of_body(body, input.bodies);
        let ids = of_body.flat_map(|collider| contacts.of_collider(collider, colliders));
        for contact in ids.map(|id| contacts.get(id)).filter(|contact| contact.slot.is_some()) {
            let rows = contact.bodies.map(|body| input.row_of(body));
            let mut manifolds = core::iter::once(&contact.manifold).chain(contacts.extra_of(contact));
            if manifolds.any(|manifold| ends(contact, manifold, rows)) {
                for (body, row) in contact.bodies.into_iter().zip(rows) {
                    if row >= bodies.first_dynamic && self.rows.insert(row) {
                        self.bodies.push(body);
                    }
                }
            }
        }
    }
}

fn velocity(bodies: &BodyRows, row: u32) -> (Vector, Angular) {
    bodies.rows[row as usize].velocity()
}

/// Whether the normal impulse would give a body of a manifold the speed of a blow.
fn is_pressed(manifold: &Manifold, rows: [u32; 2], bodies: &BodyRows, params: &SubstepParams) -> bool {
    let [a, b] = rows.map(|row| bodies.masses[row as usize].inv_mass());
    let impulse: f32 = manifold.points().iter().map(|point| point.impulse).sum();
    impulse * max(a, b) > params.blow_speed
}

/// The speed at which all points of a manifold open, m/s.
fn opening(contact: &Contact, manifold: &Manifold, rows: [u32; 2], bodies: &BodyRows) -> f32 {
    let [(va, wa), (vb, wb)] = rows.map(|row| velocity(bodies, row));
    let speed = |arm| (vb + wb.cross(arm - contact.frozen.offset) - va - wa.cross(arm)).dot(manifold.normal);
    manifold.points().iter().fold(f32::INFINITY, |least, point| min(least, speed(point.anchor)))
}
