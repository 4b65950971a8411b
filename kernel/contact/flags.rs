//! The state bits of a contact that follow from its manifold: deep overlap and platforms.

use super::input::{NarrowPhaseInput, smaller};
use super::record::{Contact, ContactFlags};
use crate::math::min;
use crate::shape::Shape;
use crate::tuning::contact::DEEP;
use crate::tuning::manifold::SAME;

/// Sets the bits that follow from a recomputed manifold: that of deep overlap, and that the embedder has changed nothing. Only contacts whose bodies were `placed` where they are
/// can become deep. What pushes nothing is never deep.
#[inline(always)]
pub(super) fn recomputed<S>(input: &NarrowPhaseInput<S>, contact: &mut Contact, placed: bool) {
    let deep = match (contact.flags.has(ContactFlags::DEEP), placed && !contact.is_inert()) {
        (true, _) => overlaps_by(input, SAME, contact),
        (false, true) => overlaps_by(input, DEEP, contact),
        (false, false) => false,
    };
    contact.flags.set(ContactFlags::DEEP, deep);
    contact.flags.set(ContactFlags::CHANGED, false);
}

/// Clears the bit of deep overlap if a recycled contact does not overlap deeply any more.
#[inline(always)]
pub(super) fn recycled<S>(input: &NarrowPhaseInput<S>, contact: &mut Contact) {
    if contact.flags.has(ContactFlags::DEEP) {
        contact.flags.set(ContactFlags::DEEP, overlaps_by(input, SAME, contact));
    }
}

/// Whether the shapes overlap by more than a share of the smaller one's reach.
fn overlaps_by<S>(input: &NarrowPhaseInput<S>, share: f32, contact: &Contact) -> bool {
    let deepest = contact.manifold.points().iter().fold(0.0, |d, p| min(d, p.separation));
    let [a, b] = input.reaches(contact);
    let reach = smaller([a.extent, b.extent]);
    deepest < 0.0 && deepest < -share * reach
}

/// Sets the bits that name the platform, the body which contacts do not turn. Two round shapes have none, since one can
/// roll under the same normal; what stands on its flat end is not round there.
#[inline(always)]
pub(super) fn set_platform<S>(input: &NarrowPhaseInput<S>, contact: &mut Contact) {
    let is_round = |side: usize| match input.shapes(contact)[side] {
        Shape::Ball(_) | Shape::Capsule(_) | Shape::Segment(_) => true,
        Shape::Curved(_) => contact.manifold.radii[side] != 0.0,
        _ => false,
    };
    let are_round = is_round(0) && is_round(1);
    let [a, b] = contact.bodies.map(|body| !are_round && !input.is_dynamic(body));
    contact.flags.set(ContactFlags::PLATFORM_A, a);
    contact.flags.set(ContactFlags::PLATFORM_B, b && !a);
}
