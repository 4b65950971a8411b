//! State that follows from a contact's update: its bits of deep overlap and platform, and the travel up to
//! which it needs no further update.
//!
//! An update bounds how far the surfaces may move against each other before the manifold must be recomputed.
//! The bodies may travel half of this distance until the next update. Each body accumulates an upper bound of
//! its surface's travel. At its end the solver stores the separations if they are valid for the start of the
//! next step.

use super::input::{Sides, smaller};
use super::record::{Contact, ContactFlags};
use crate::math::min;
use crate::shape::Shape;
use crate::table::{BodyPose, TravelScale};
use crate::tuning::contact::{CALM_SHARE, DEEP};
use crate::tuning::manifold::SAME;

/// A contact with any of these bits is updated in each step.
const LOOKED_AT: ContactFlags = ContactFlags::DEEP
    .union(ContactFlags::COMPOSITE)
    .union(ContactFlags::SENSOR)
    .union(ContactFlags::SLIDES_A)
    .union(ContactFlags::SLIDES_B)
    .union(ContactFlags::CHANGED);

impl Contact {
    /// Whether the next update may leave the contact as it is, if its bodies hardly move until then.
    #[inline(always)]
    pub(crate) fn may_be_calm(&self) -> bool {
        self.flags.has(ContactFlags::FROZEN) && !self.flags.any(LOOKED_AT)
    }

    /// Called when the manifold is recomputed: the next update may not skip the contact.
    #[inline(always)]
    pub(super) fn excite(&mut self, poses: [&BodyPose; 2]) {
        self.calm_until = travel(poses);
        self.flags.set(ContactFlags::CALM, false);
    }

    /// Called after an update. The surfaces may move `allowed` metres before the manifold must be recomputed,
    /// and have moved `moved` metres.
    #[inline(always)]
    pub(super) fn calm_down(&mut self, poses: [&BodyPose; 2], scale: TravelScale, allowed: f32, moved: f32) {
        let way = allowed * CALM_SHARE - moved;
        self.calm_until = travel(poses).wrapping_add(scale.travelled(way));
        // A contact with points becomes calm when the solver stores its separations.
        let is_followed = self.manifold.count == 0 && self.may_be_calm();
        self.flags.set(ContactFlags::CALM, is_followed);
    }
}

/// The sum of both bodies' travels.
#[inline(always)]
fn travel([a, b]: [&BodyPose; 2]) -> u32 {
    a.travel.wrapping_add(b.travel)
}

impl Sides<'_> {
    /// Whether a contact needs no update. A touching contact is calm again only after the solver stores its
    /// separations.
    #[inline(always)]
    pub(super) fn is_calm(&self, contact: &mut Contact) -> bool {
        let &Self { input, poses, .. } = self;
        let flags = contact.flags;
        if !flags.has(ContactFlags::CALM) {
            return false;
        }
        let touches = flags.has(ContactFlags::TOUCHING);
        contact.flags.set(ContactFlags::CALM, !touches);
        let speed = poses[0].speed + poses[1].speed;
        let left = contact.calm_until.wrapping_sub(travel(poses)) as i32;
        let is_near = speed * input.dt < input.bodies.travel_scale.way_of(left);
        if !(is_near && input.recycle_distance > 0.0) || contact.revisions != self.revisions() {
            return false;
        }
        if !touches {
            return true;
        }
        let is_turned = |side: usize, flag| flags.has(flag) && poses[side].speed != 0.0;
        if is_turned(0, ContactFlags::PLATFORM_A) || is_turned(1, ContactFlags::PLATFORM_B) {
            return false;
        }
        input.sliding_side(contact).is_none()
    }

    /// Updates the bits of a recomputed contact: deep overlap, and no change by the embedder. Only a contact
    /// whose bodies were `placed` at their poses can become deep. An inert contact is never deep.
    #[inline(always)]
    pub(super) fn after_recomputing(&self, contact: &mut Contact, placed: bool) {
        let deep = match (contact.flags.has(ContactFlags::DEEP), placed && !contact.is_inert()) {
            (true, _) => self.overlaps_by(SAME, contact),
            (false, true) => self.overlaps_by(DEEP, contact),
            (false, false) => false,
        };
        contact.flags.set(ContactFlags::DEEP, deep);
        contact.flags.set(ContactFlags::CHANGED, false);
    }

    /// Clears the bit of deep overlap if a recycled contact no longer overlaps deeply.
    #[inline(always)]
    pub(super) fn after_recycling(&self, contact: &mut Contact) {
        if contact.flags.has(ContactFlags::DEEP) {
            contact.flags.set(ContactFlags::DEEP, self.overlaps_by(SAME, contact));
        }
    }

    /// Whether the shapes overlap by more than a share of the smaller reach.
    fn overlaps_by(&self, share: f32, contact: &Contact) -> bool {
        let deepest = contact.manifold.points().iter().fold(0.0, |d, p| min(d, p.separation));
        let [a, b] = self.reaches();
        let reach = smaller([a.extent, b.extent]);
        deepest < 0.0 && deepest < -share * reach
    }

    /// Sets the bits of the platform, the body that contacts do not turn. Two round shapes have no platform,
    /// because one can roll under an unchanged normal. A curved shape on its flat end is not round.
    #[inline(always)]
    pub(super) fn set_platform(&self, contact: &mut Contact) {
        let is_round = |side: usize| match self.shapes()[side] {
            Shape::Ball(_) | Shape::Capsule(_) | Shape::Segment(_) => true,
            Shape::Curved(_) => contact.manifold.radii[side] != 0.0,
            _ => false,
        };
        let are_round = is_round(0) && is_round(1);
        let [a, b] = self.are_dynamic().map(|is_dynamic| !are_round && !is_dynamic);
        contact.flags.set(ContactFlags::PLATFORM_A, a);
        contact.flags.set(ContactFlags::PLATFORM_B, b && !a);
    }
}
