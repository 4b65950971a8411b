//! Released loads: bodies whose contacts begin a step without impulses.
//!
//! A crate jammed between an immovable door and wall has no solution: each sweep raises the impulses of its
//! contacts, up to some hundred times the impulse that moves it. When the door opens, a sweep lowers an
//! impulse by at most the mass times the opening speed, so the door drags the crate along for half a
//! second.
//!
//! Decision: if a kinematic body separates from a pressed body at more than the blow speed, the load ends
//! at once, in all contacts that the load reached through bodies: their impulses balance, and the remaining
//! impulses would throw a body. Bodies that impulses move give way instead of jamming, so sweeps reduce
//! their loads.

use super::input::RowInput;
use super::{BodyRows, SubstepParams};
use crate::contact::{Contact, Manifold};
use crate::data::BitSet;
use crate::math::{Angular, Vector, max, min};

/// The bodies whose load ended. Buffers are kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Released {
    /// Ids of these bodies, in the order in which they were found.
    bodies: Vec<u32>,
    rows: BitSet,
}

impl Released {
    /// Whether the contact between two body rows begins without impulses.
    #[inline(always)]
    pub(super) fn concerns(&self, rows: [u32; 2]) -> bool {
        !self.bodies.is_empty() && rows.into_iter().any(|row| self.rows.contains(row))
    }

    /// Finds the bodies whose load ends in this step.
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

    /// Adds the dynamic bodies of all contacts of `body` with a manifold for which `ends` holds.
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

/// Whether the normal impulse is large enough to give a body of the manifold the blow speed.
fn is_pressed(manifold: &Manifold, rows: [u32; 2], bodies: &BodyRows, params: &SubstepParams) -> bool {
    let [a, b] = rows.map(|row| bodies.masses[row as usize].inv_mass());
    let impulse: f32 = manifold.points().iter().map(|point| point.impulse).sum();
    impulse * max(a, b) > params.blow_speed
}

/// The least separation speed of the points of a manifold, m/s.
fn opening(contact: &Contact, manifold: &Manifold, rows: [u32; 2], bodies: &BodyRows) -> f32 {
    let [(va, wa), (vb, wb)] = rows.map(|row| velocity(bodies, row));
    let speed = |arm| (vb + wb.cross(arm - contact.frozen.offset) - va - wa.cross(arm)).dot(manifold.normal);
    manifold.points().iter().fold(f32::INFINITY, |least, point| min(least, speed(point.anchor)))
}
