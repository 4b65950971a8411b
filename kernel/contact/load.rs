//! Load that sliding colliders hand on from piece to piece of the ground.
//!
//! A body that leaves a tile, or comes to another facet of a mesh, loses the contact points there with their impulses. It
//! would have to sink for the other points to take its weight up again, and friction, limited by the impulses of the
//! moment, would be too weak, and too strong as the body is lifted. So the impulses of points that a sliding collider loses
//! go to the nearest points that it has with the same normal. Weight is kept, and with it friction.
//!
//! Points are lost in parallel, and handed on by one thread in the order of contacts.

use super::input::NarrowPhaseInput;
use super::record::{Contact, Lost, Manifold, ManifoldPoint};
use super::table::ContactTable;
use crate::math::Vector;
use crate::tuning::manifold::SAME_NORMAL;

/// The manifolds of a sliding contact before it is recomputed.
pub(super) struct Before {
    side: usize,
    manifold: Manifold,
    /// As in [`Frozen`](super::Frozen).
    offset: Vector,
}

/// The unit normal towards a side of a contact.
fn toward(side: usize, m: &Manifold) -> Vector {
    if side == 0 { -m.normal } else { m.normal }
}

/// From the centre of mass of a side's body to a point.
fn place(side: usize, p: &ManifoldPoint, offset: Vector) -> Vector {
    if side == 0 { p.anchor } else { p.anchor - offset }
}

impl Before {
    /// The manifolds of a contact, if it slides under load.
    #[inline(always)]
    pub(super) fn of<S>(input: &NarrowPhaseInput<S>, contact: &Contact) -> Option<Self> {
        if contact.manifold.count == 0 || !contact.is_solved() || !input.match_points {
            return None;
        }
        let side = input.sliding_side(contact)?;
        Some(Self { side, manifold: contact.manifold, offset: contact.frozen.offset })
    }

    /// Adds the points that the contact has no more. `old_extra` are its old manifolds after the first, `new` its present ones.
    pub(super) fn note_lost<'a>(
        &self,
        id: u32,
        contact: &Contact,
        old_extra: &[Manifold],
        new: impl Iterator<Item = &'a Manifold> + Clone,
        lost: &mut Vec<Lost>,
    ) {
        for (number, old) in core::iter::once(&self.manifold).chain(old_extra).enumerate() {
            let normal = toward(self.side, old);
            for (i, p) in old.points().iter().enumerate().filter(|(_, p)| p.impulse > 0.0) {
                let has = |m: &Manifold| m.points().iter().any(|q| q.feature == p.feature && q.impulse > 0.0);
                if new.clone().any(|m| m.normal.dot(old.normal) > SAME_NORMAL && has(m)) {
                    continue;
                }
                lost.push(Lost {
                    contact: id,
                    number: (number * old.points.len() + i) as u32,
                    collider: contact.colliders[self.side],
                    place: place(self.side, p, self.offset),
                    normal,
                    impulse: p.impulse,
                });
            }
        }
    }
}

/// Adds the points of a manifold that is not solved any more.
pub(super) fn note_internal(
    (id, index): (u32, u32),
    side: usize,
    contact: &Contact,
    m: &Manifold,
    lost: &mut Vec<Lost>,
) {
    // After those that were lost before.
    let first = (1 << 31) + index * m.points.len() as u32;
    for (i, p) in m.points().iter().enumerate().filter(|(_, p)| p.impulse > 0.0) {
        lost.push(Lost {
            contact: id,
            number: first + i as u32,
            collider: contact.colliders[side],
            place: place(side, p, contact.frozen.offset),
            normal: toward(side, m),
            impulse: p.impulse,
        });
    }
}

impl ContactTable {
    /// Gives the impulses of lost points to the nearest ones, and empties the list.
    pub(super) fn hand_on<S>(&mut self, input: &NarrowPhaseInput<S>) {
        let mut lost = core::mem::take(&mut self.lost);
        lost.sort_unstable_by_key(|lost| (lost.contact, lost.number));
        for lost in lost.drain(..) {
            let Some((id, index, point)) = self.nearest(input, &lost) else { continue };
            self.manifold_mut(id, index).points[point].impulse += lost.impulse;
        }
        self.lost = lost;
    }

    /// The nearest point with the same normal: its contact, manifold and number.
    fn nearest<S>(&self, input: &NarrowPhaseInput<S>, lost: &Lost) -> Option<(u32, u32, usize)> {
        let mut best = None;
        let mut least = f32::INFINITY;
        let contacts = self.of_collider(lost.collider, input.colliders);
        for id in contacts.filter(|id| self.slides(*id, lost.collider)) {
            let contact = self.get(id);
            let side = usize::from(contact.colliders[1] == lost.collider);
            for index in 0..=u32::from(contact.extra_count) {
                let Some(m) = self.manifold(contact, index).filter(|m| !m.is_internal) else { continue };
                if !(toward(side, m).dot(lost.normal) > SAME_NORMAL) {
                    continue;
                }
                for (i, p) in m.points().iter().enumerate().filter(|(_, p)| p.separation < input.tolerance) {
                    let away = (place(side, p, contact.frozen.offset) - lost.place).length_squared();
                    if away < least {
                        least = away;
                        best = Some((id, index, i));
                    }
                }
            }
        }
        best
    }
}
