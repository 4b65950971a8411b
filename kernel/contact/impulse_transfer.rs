//! Impulses that sliding colliders transfer from piece to piece of the ground.
//!
//! A body that leaves a tile, or comes to another facet of a mesh, loses contact points with their impulses.
//! The body would have to sink before its other points carry the weight again. Friction, limited by the
//! present impulses, would be too weak meanwhile, and too strong as the body is lifted. So the impulse of
//! each point that a sliding collider loses goes to its nearest point with the same normal. This keeps the
//! supported weight, and with it friction.
//!
//! Workers note lost points in parallel; one thread transfers their impulses in the order of contacts.

use super::input::NarrowPhaseInput;
use super::record::{Contact, ContactFlags, LoadPoint, LostImpulse, Manifold, ManifoldPoint};
use super::table::ContactTable;
use crate::math::{DIM, Vector};
use crate::tuning::manifold::SAME_NORMAL;

/// The manifolds of a sliding contact before it is recomputed.
pub(super) struct PreviousManifold {
    side: usize,
    manifold: Manifold,
    /// As in [`Frozen`](super::Frozen).
    offset: Vector,
}

/// The unit normal towards a side of a contact.
pub(super) fn toward(side: usize, m: &Manifold) -> Vector {
    if side == 0 { -m.normal } else { m.normal }
}

/// From the centre of mass of a side's body to a point.
fn place(side: usize, p: &ManifoldPoint, offset: Vector) -> Vector {
    if side == 0 { p.anchor } else { p.anchor - offset }
}

/// The loaded points of a manifold of a contact, numbered from `first`, each with its impulse to transfer.
/// `side` is the side of the sliding collider. `offset` is as in [`Frozen`](super::Frozen).
fn loaded(
    [contact, first]: [u32; 2],
    collider: u32,
    side: usize,
    m: &Manifold,
    offset: Vector,
) -> impl Iterator<Item = (&ManifoldPoint, LostImpulse)> {
    let normal = toward(side, m);
    m.points().iter().zip(first..).filter(|(p, _)| p.impulse > 0.0).map(move |(p, number)| {
        let (place, impulse) = (place(side, p, offset), p.impulse);
        (p, LostImpulse { contact, number, collider, place, normal, impulse })
    })
}

impl PreviousManifold {
    /// The manifolds of a contact, if it slides under load.
    #[inline(always)]
    pub(super) fn of(input: &NarrowPhaseInput, contact: &Contact) -> Option<Self> {
        if contact.manifold.count == 0 || !contact.is_solved() || !input.match_points {
            return None;
        }
        let side = input.sliding_side(contact)?;
        Some(Self { side, manifold: contact.manifold, offset: contact.frozen.offset })
    }

    /// Adds the loaded points that the contact no longer has. `old_extra` are its old manifolds after the
    /// first, `new` its present manifolds.
    pub(super) fn note_lost<'a>(
        &self,
        id: u32,
        contact: &Contact,
        old_extra: &[Manifold],
        new: impl Iterator<Item = &'a Manifold> + Clone,
        lost: &mut Vec<LostImpulse>,
    ) {
        for (number, old) in core::iter::once(&self.manifold).chain(old_extra).enumerate() {
            let is_kept = |p: &ManifoldPoint| {
                let has = |m: &Manifold| m.points().iter().any(|q| q.feature == p.feature && q.impulse > 0.0);
                new.clone().any(|m| m.normal.dot(old.normal) > SAME_NORMAL && has(m))
            };
            let first = (number * old.points.len()) as u32;
            let points = loaded([id, first], contact.colliders[self.side], self.side, old, self.offset);
            lost.extend(points.filter(|(p, _)| !is_kept(p)).map(|(_, lost)| lost));
        }
    }
}

/// Adds the loaded points of a manifold that is no longer solved.
pub(super) fn note_internal(
    (id, index): (u32, u32),
    side: usize,
    contact: &Contact,
    m: &Manifold,
    lost: &mut Vec<LostImpulse>,
) {
    // Numbered after the points of `note_lost`.
    let first = (1 << 31) + index * m.points.len() as u32;
    let points = loaded([id, first], contact.colliders[side], side, m, contact.frozen.offset);
    lost.extend(points.map(|(_, lost)| lost));
}

/// The axis along which points are spread farthest.
fn longest_axis(points: &[LoadPoint]) -> usize {
    let Some(first) = points.first() else { return 0 };
    let (low, high) = points
        .iter()
        .fold((first.place, first.place), |(low, high), p| (low.min(p.place), high.max(p.place)));
    let size = (high - low).to_array();
    (1..DIM).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best })
}

/// The nearest point with the normal of a lost point. Points are sorted along `axis`. Of equally near points,
/// the first in the collider's order is taken.
fn nearest<'a>(points: &'a [LoadPoint], axis: usize, lost: &LostImpulse) -> Option<&'a LoadPoint> {
    let along = |p: &LoadPoint| p.place.to_array()[axis] - lost.place.to_array()[axis];
    let (mut below, mut above) = points.split_at(points.partition_point(|p| along(p) < 0.0));
    let (mut best, mut least) = (None::<&LoadPoint>, f32::INFINITY);
    loop {
        let p = match (below.split_last(), above.split_first()) {
            (Some((p, rest)), other) if other.is_none_or(|(q, _)| -along(p) < along(q)) => {
                below = rest;
                p
            }
            (_, Some((p, rest))) => {
                above = rest;
                p
            }
            (_, None) => return best,
        };
        if along(p) * along(p) > least {
            return best;
        }
        if p.normal.dot(lost.normal) > SAME_NORMAL {
            let away = (p.place - lost.place).length_squared();
            if away < least || away == least && best.is_some_and(|best| p.order < best.order) {
                (best, least) = (Some(p), away);
            }
        }
    }
}

impl ContactTable {
    /// Transfers the impulses of lost points to the nearest points, and clears the list.
    pub(super) fn transfer_impulses(&mut self, input: &NarrowPhaseInput) {
        let (mut lost, mut points) =
            (core::mem::take(&mut self.lost), core::mem::take(&mut self.load_points));
        lost.sort_unstable_by_key(|lost| (lost.collider, lost.contact, lost.number));
        for of_one in lost.chunk_by(|a, b| a.collider == b.collider) {
            self.list_load_points(input, of_one[0].collider, &mut points);
            let axis = longest_axis(&points);
            points.sort_unstable_by(|a, b| a.place.to_array()[axis].total_cmp(&b.place.to_array()[axis]));
            for lost in of_one {
                let Some(p) = nearest(&points, axis, lost) else { continue };
                self.manifold_mut(p.contact, p.index).points[p.point as usize].impulse += lost.impulse;
            }
        }
        lost.clear();
        points.clear();
        (self.lost, self.load_points) = (lost, points);
    }

    /// Lists the points of a sliding collider that can bear load: closer than the tolerance, in a solved
    /// manifold.
    fn list_load_points(&self, input: &NarrowPhaseInput, collider: u32, points: &mut Vec<LoadPoint>) {
        points.clear();
        for (id, index, side, m) in self.sliding_manifolds(input, collider).filter(|(.., m)| !m.is_internal) {
            let offset = self.get(id).frozen.offset;
            for (p, point) in m.points().iter().zip(0..).filter(|(p, _)| p.separation < input.tolerance) {
                let (order, place, normal) = (points.len() as u32, place(side, p, offset), toward(side, m));
                points.push(LoadPoint { contact: id, index, point, order, place, normal });
            }
        }
    }

    /// The manifolds of the contacts in which a collider slides, each with its contact, its number in the
    /// contact, and the collider's side.
    pub(super) fn sliding_manifolds(
        &self,
        input: &NarrowPhaseInput,
        collider: u32,
    ) -> impl Iterator<Item = (u32, u32, usize, &Manifold)> {
        let contacts = self.of_collider(collider, input.colliders).filter_map(move |id| {
            let contact = self.get(id);
            let side = usize::from(contact.colliders[1] == collider);
            let slides = contact.flags.has([ContactFlags::SLIDES_A, ContactFlags::SLIDES_B][side]);
            (slides && self.is_active(id)).then_some((id, contact, side))
        });
        contacts.flat_map(move |(id, contact, side)| {
            let manifolds = core::iter::once(&contact.manifold).chain(self.extra_of(contact));
            manifolds.zip(0..).map(move |(manifold, index)| (id, index, side, manifold))
        })
    }
}
