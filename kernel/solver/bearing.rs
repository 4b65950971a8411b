//! Light bodies below heavy ones: contacts see them with more mass.
//!
//! A soft contact has the stiffness m ω² of its effective mass m, and one sweep changes its impulse by at most m times
//! the approach speed. Light bodies below a heavy one are therefore soft springs that harden slowly: 1,000 kg crushed a
//! tower of five boxes of 1 kg. More sweeps help in proportion only, a larger mass helps at once.
//!
//! Decision: the mass is that of the body in all its contacts, not of one contact. Impulses between bodies then still
//! balance, and forces at rest are those of the larger mass. Added mass is a share of the load ([`FULL_SAG`]), so what
//! the heavy body does hardly changes. Only compression counts, not the net impulse: a body that hits a wall keeps its
//! mass. Other engines let users scale masses by hand.
//!
//! Decision: each world axis has its own mass, by the compression along it. A light slab that slides below a heavy block has
//! its own mass along its way, and friction gives the block no more momentum than the slab has. Blows see the true mass.
//!
//! Decision: masses are doubled step by step, upward at once and downward late. A mass that follows the load is fed
//! back by the load, and such a tower shakes until it falls.

use super::input::RowInput;
use super::{BodyRows, SubstepParams};
use crate::contact::{Contact, ContactFlags, ContactTable, Manifold};
use crate::math::{DIM, Vector, max, min};
use crate::tuning::solver::{FULL_SAG, HEAVY, MAX_DOUBLINGS, PRESSED, STEPS_TO_HALVE};

/// Finds the bodies that bear much more than their weight. Buffers are kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Bearing {
    /// By body row. Empty in steps without any such body.
    loads: Vec<Load>,
    /// Body rows of contacts that press.
    presses: Vec<[u32; 2]>,
    /// Bodies with more mass in this step, by id, and for each axis for how many steps of halving it will last.
    raised: Vec<(u32, [u8; DIM])>,
}

/// The impulses of all contacts of a body in the last substep, N·s.
#[derive(Clone, Copy, Debug)]
struct Load {
    /// The sum of their lengths along each axis.
    total: Vector,
    /// Their sum.
    net: Vector,
    /// Whether contacts that press connect the body with one below a heavy body.
    is_below: bool,
    /// The ratio of the body's mass along each axis to the one that contacts see.
    share: Vector,
}

impl Load {
    const NONE: Self = Self { total: Vector::ZERO, net: Vector::ZERO, is_below: false, share: Vector::ONE };

    /// The impulse that compresses the body along each axis: the part that is balanced.
    fn compression(&self) -> Vector {
        (self.total - self.net.abs()).max(Vector::ZERO) * 0.5
    }
}

/// The number of doublings of a mass that lasts for a number of steps.
fn doublings(steps: u8) -> u8 {
    steps.div_ceil(STEPS_TO_HALVE)
}

/// The steps for which the added mass of a body lasts that would sag by `sag` times the maximum, given those before.
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

/// The sag of a contact per velocity that its impulse gives to a body: the overlap at rest of its spring, or the distance
/// of a substep, in which no impulse can grow. In seconds.
pub(super) fn sag_rate(params: &SubstepParams) -> f32 {
    max(params.soft.sag_rate(), params.h)
}

impl Bearing {
    /// Starts a step: no body has more mass.
    pub(super) fn clear(&mut self) {
        self.loads.clear();
        self.raised.clear();
    }

    /// Raises the masses of overloaded bodies, as contacts see them. Returns whether there are any. `are_joined` tells whether two
    /// body rows are of one tree of joints.
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

    /// Share of the push-out speed of a contact between two body rows.
    #[inline(always)]
    pub(super) fn push_share(&self, rows: [u32; 2]) -> f32 {
        let is_raised = |row| self.share(row) != Vector::ONE;
        if !self.raised.is_empty() && rows.into_iter().any(is_raised) { 0.5 / HEAVY } else { 1.0 }
    }

    /// The ratio of a body's mass along each axis to the one that contacts see.
    #[inline(always)]
    pub(super) fn share(&self, row: u32) -> Vector {
        self.loads.get(row as usize).map_or(Vector::ONE, |load| load.share)
    }

    /// Stores which bodies have more mass, for the next step.
    pub(super) fn store(&self, contacts: &mut ContactTable) {
        debug_assert!(self.raised.is_sorted(), "bodies are in the order of ids");
        contacts.raised_masses.clone_from(&self.raised);
    }

    /// Sums up the impulses of the last substep by body row, in the order of contacts, and lists contacts that press.
    /// Deep overlap and fast bodies do not count: their impulses are no load at rest. Nor do contacts within a tree of joints,
    /// which presses its bodies on each other as well as a load.
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

    /// Adds a manifold to the loads, and to the list if it presses. Marks the lighter body if the other is heavy and bears
    /// on it with its weight, or by other forces: a blow without any is no load.
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

    /// Marks all bodies that contacts that press connect with marked ones.
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

    /// The steps after a number of steps with a load.
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
        // A load that wavers changes nothing.
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
