//! Light bodies below heavy ones: contacts see them with a larger mass.
//!
//! A soft contact has the stiffness m ω² of its effective mass m, and one sweep changes its impulse by at
//! most m times the approach speed. Contacts of light bodies below a heavy one are therefore soft springs
//! whose impulse grows slowly: 1,000 kg crushed a tower of five boxes of 1 kg. More sweeps help only in
//! proportion; a larger mass helps at once.
//!
//! Decision: the body gets a larger mass in all of its contacts, not in a single contact. Impulses between
//! bodies then still balance, and forces at rest are the same as for a true mass of that size. The added
//! mass is a share of the load ([`FULL_SAG`]), so the motion of the heavy body hardly changes. Only
//! compression counts, not the net impulse: a body that hits a wall keeps its mass. Other engines let users
//! scale masses by hand.
//!
//! Decision: each world axis has its own mass, by the compression along that axis. A light slab that slides
//! below a heavy block keeps its true mass along the sliding direction, and friction gives the block no
//! more momentum than the slab has. Blows see the true mass.
//!
//! Decision: masses are doubled and halved in steps, doubled at once and halved late. If the mass followed
//! the load continuously, the load would feed it back, and the tower would shake until it falls.

use super::input::RowInput;
use super::{BodyRows, SubstepParams};
use crate::contact::{Contact, ContactFlags, ContactTable, Manifold};
use crate::math::{DIM, Vector, max, min};
use crate::tuning::solver::{FULL_SAG, HEAVY, MAX_DOUBLINGS, PRESSED, STEPS_TO_HALVE};

/// Finds bodies whose load is much larger than their weight. Buffers are kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct MassScaling {
    /// The load of each body row. Empty in steps without overloaded bodies.
    loads: Vec<Load>,
    /// The two body rows of each pressing contact.
    presses: Vec<[u32; 2]>,
    /// Bodies with raised mass in this step, by id, and for each axis the number of steps until the mass is
    /// back to its true value.
    raised: Vec<(u32, [u8; DIM])>,
}

/// The impulses of all contacts of a body in the last substep, N·s.
#[derive(Clone, Copy, Debug)]
struct Load {
    /// Sum of the magnitudes of the impulses along each axis.
    total: Vector,
    /// Sum of the impulses.
    net: Vector,
    /// Whether a chain of pressing contacts connects the body with a body directly below a heavy one.
    is_below: bool,
    /// The ratio of the body's true mass to the mass that contacts see, along each axis.
    share: Vector,
}

impl Load {
    const NONE: Self = Self { total: Vector::ZERO, net: Vector::ZERO, is_below: false, share: Vector::ONE };

    /// The impulse that compresses the body along each axis: the balanced part of the impulses.
    fn compression(&self) -> Vector {
        (self.total - self.net.abs()).max(Vector::ZERO) * 0.5
    }
}

/// The number of doublings of a mass that lasts for `steps` more steps.
fn doublings(steps: u8) -> u8 {
    steps.div_ceil(STEPS_TO_HALVE)
}

/// The number of steps for which the added mass of a body lasts. Without added mass, the body would sag by
/// `sag` times the maximum; `last` is the number of the last step.
fn next_steps(sag: f32, last: u8) -> u8 {
    let wanted = sag / FULL_SAG;
    let before = doublings(last);
    let (mut now, mut mass) = (before, (1u32 << before) as f32);
    if wanted < 0.25 * mass {
        return last.saturating_sub(1);
    }
    while wanted >= 2.0 * mass && now < MAX_DOUBLINGS {
        now += 1;
        mass += mass;
    }
    if now > before { now * STEPS_TO_HALVE } else { last }
}

/// The sag of a contact per unit of velocity that its impulse gives a body, in seconds: the overlap of its
/// spring at rest, or the distance moved in one substep, within which no impulse can grow.
pub(super) fn sag_rate(params: &SubstepParams) -> f32 {
    max(params.soft.sag_rate(), params.h)
}

impl MassScaling {
    /// Starts a step: no body has raised mass.
    pub(super) fn clear(&mut self) {
        self.loads.clear();
        self.raised.clear();
    }

    /// Raises the masses of overloaded bodies, as contacts see them. Returns whether any mass was raised.
    /// `are_joined` tells whether two body rows belong to one tree of joints.
    pub(super) fn raise_masses(
        &mut self,
        input: &RowInput,
        bodies: &mut BodyRows,
        params: &SubstepParams,
        are_joined: impl Fn([u32; 2]) -> bool,
    ) -> bool {
        let sag_rate = sag_rate(params) / params.max_sag;
        self.sum_up(input, bodies, params, are_joined);
        self.spread();
        let before = &input.contacts.raised_masses;
        for body in input.bodies.awake_dynamic() {
            let row = input.row_of(body) as usize;
            let load = &mut self.loads[row];
            let last = before.binary_search_by_key(&body, |(id, _)| *id).map_or([0; DIM], |i| before[i].1);
            if !load.is_below && last == [0; DIM] {
                continue;
            }
            let sags = (load.compression() * (bodies.masses[row].inv_mass() * sag_rate)).to_array();
            let steps: [u8; DIM] = core::array::from_fn(|axis| next_steps(sags[axis], last[axis]));
            if steps != [0; DIM] {
                load.share = Vector::from_array(steps.map(|steps| 1.0 / (1u32 << doublings(steps)) as f32));
                bodies.lower_inv_mass(row, load.share);
                self.raised.push((body, steps));
            }
        }
        self.raised.sort_unstable();
        !self.raised.is_empty()
    }

    /// Factor of the push-out speed of a contact between two body rows.
    #[inline(always)]
    pub(super) fn push_share(&self, rows: [u32; 2]) -> f32 {
        let is_raised = |row| self.share(row) != Vector::ONE;
        if !self.raised.is_empty() && rows.into_iter().any(is_raised) { 0.5 / HEAVY } else { 1.0 }
    }

    /// The ratio of a body's true mass to the mass that contacts see, along each axis.
    #[inline(always)]
    pub(super) fn share(&self, row: u32) -> Vector {
        self.loads.get(row as usize).map_or(Vector::ONE, |load| load.share)
    }

    /// Stores the bodies with raised mass, for the next step.
    pub(super) fn store(&self, contacts: &mut ContactTable) {
        debug_assert!(self.raised.is_sorted(), "bodies are in the order of ids");
        contacts.raised_masses.clone_from(&self.raised);
    }

    /// Sums up the impulses of the last substep by body row, in the order of contacts, and lists pressing
    /// contacts. Contacts with deep overlap or of fast bodies do not count: their impulses are not the load
    /// of bodies at rest. Contacts within a tree of joints do not count either: joints press bodies
    /// together as a load does.
    fn sum_up(
        &mut self,
        input: &RowInput,
        bodies: &BodyRows,
        params: &SubstepParams,
        are_joined: impl Fn([u32; 2]) -> bool,
    ) {
        self.loads.clear();
        self.loads.resize(bodies.rows.len(), Load::NONE);
        self.presses.clear();
        let contacts = input.contacts;
        for id in contacts.active() {
            let contact = contacts.get(id);
            if contact.slot.is_none() || contact.flags.has(ContactFlags::DEEP) {
                continue;
            }
            let rows = contact.bodies.map(|body| input.row_of(body));
            if are_joined(rows) {
                continue;
            }
            for manifold in core::iter::once(&contact.manifold).chain(contacts.extra_of(contact)) {
                if manifold.count > 0 && speed(contact, manifold, rows, bodies) <= params.max_push_speed {
                    self.add(manifold, rows, bodies, params);
                }
            }
        }
    }

    /// Adds a manifold to the loads, and to the list if it presses. Marks the lighter body if the other
    /// body is heavy and the impulse is at most [`HEAVY`] times the impulse of its weight and other forces
    /// in a substep; a larger impulse is a blow, not a load.
    fn add(&mut self, manifold: &Manifold, rows: [u32; 2], bodies: &BodyRows, params: &SubstepParams) {
        let impulse: f32 = manifold.points().iter().map(|point| point.impulse).sum();
        for (row, sign) in rows.into_iter().zip([-1.0, 1.0]) {
            let load = &mut self.loads[row as usize];
            load.total += manifold.normal.abs() * impulse;
            load.net += manifold.normal * (impulse * sign);
        }
        let [a, b] = rows.map(|row| bodies.masses[row as usize].inv_mass());
        let is_press = impulse * max(a, b) * sag_rate(params) > PRESSED * params.max_sag;
        if is_press && rows.iter().all(|row| *row >= bodies.first_dynamic) {
            self.presses.push(rows);
            let [light, heavy] = if a > b { rows } else { [rows[1], rows[0]] };
            let weight = bodies.motions[heavy as usize].acceleration.length() * params.h;
            if max(a, b) > HEAVY * min(a, b) && impulse * min(a, b) <= HEAVY * weight {
                self.loads[light as usize].is_below = true;
            }
        }
    }

    /// Marks all bodies that are connected with marked bodies by pressing contacts.
    fn spread(&mut self) {
        let Self { loads, presses, .. } = self;
        let mut mark = |[a, b]: [u32; 2]| {
            let [a, b] = [a as usize, b as usize];
            let grows = loads[a].is_below != loads[b].is_below;
            loads[a].is_below |= grows;
            loads[b].is_below |= grows;
            grows
        };
        loop {
            let upward = presses.iter().fold(false, |grows, rows| mark(*rows) | grows);
            let downward = presses.iter().rev().fold(false, |grows, rows| mark(*rows) | grows);
            if !(upward || downward) {
                return;
            }
        }
    }
}

/// The relative speed of two body rows at the first point of a manifold, m/s.
fn speed(contact: &Contact, manifold: &Manifold, rows: [u32; 2], bodies: &BodyRows) -> f32 {
    let [(va, wa), (vb, wb)] = rows.map(|row| bodies.rows[row as usize].velocity());
    let arm = manifold.points[0].anchor;
    (vb + wb.cross(arm - contact.frozen.offset) - va - wa.cross(arm)).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The remaining steps after `count` steps with a load.
    fn after(wanted: f32, count: usize, last: u8) -> u8 {
        (0..count).fold(last, |last, _| next_steps(wanted * FULL_SAG, last))
    }

    #[test]
    fn masses_are_doubled_at_once_and_halved_late() {
        assert_eq!(next_steps(f32::NAN, 0), 0);
        assert_eq!(after(1.9, 10, 0), 0);
        assert_eq!(doublings(after(2.1, 1, 0)), 1);
        assert_eq!(doublings(after(33.0, 1, 0)), 5);
        assert_eq!(doublings(after(f32::INFINITY, 1, 0)), MAX_DOUBLINGS);
        // A fluctuating load changes nothing.
        for wanted in [9.0, 16.0, 32.0, 60.0] {
            assert_eq!(doublings(after(wanted, 100, after(33.0, 1, 0))), 5);
        }
        let short = STEPS_TO_HALVE as usize - 1;
        assert_eq!(doublings(after(0.0, short, after(33.0, 1, 0))), 5);
        assert_eq!(doublings(after(0.0, short + 1, after(33.0, 1, 0))), 4);
        assert_eq!(after(0.0, 5 * short + 5, after(33.0, 1, 0)), 0);
    }

    #[test]
    fn a_push_from_one_side_does_not_compress() {
        let pushed = Load { total: Vector::Y * 3.0, net: Vector::Y * -3.0, ..Load::NONE };
        assert_eq!(pushed.compression(), Vector::ZERO);
        let squeezed = Load { total: Vector::Y * 6.0, ..Load::NONE };
        assert_eq!(squeezed.compression(), Vector::Y * 3.0);
    }
}
