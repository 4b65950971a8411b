//! Contacts that need no look: their bodies have moved too little since the last one.
//!
//! A look at a contact tells how far its surfaces may move against each other until its manifold is to be computed anew. Half of that
//! way is what its bodies may travel until the next look. Each body adds up a bound of its surface's way. The solver stores the
//! separations at its end, as long as they are those of the next step's start.

use super::input::NarrowPhaseInput;
use super::record::{Contact, ContactFlags};
use crate::table::{BodyPose, TravelScale};
use crate::tuning::contact::CALM_SHARE;

/// What has to be looked at in each step.
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

    /// When the manifold is computed anew: the next update has to look at it.
    #[inline(always)]
    pub(super) fn excite(&mut self, poses: [&BodyPose; 2]) {
        self.calm_until = travel(poses);
        self.flags.set(ContactFlags::CALM, false);
    }

    /// After a look. Until the manifold is to be computed anew, surfaces may move by `allowed` metres, of which they have
    /// `moved`.
    #[inline(always)]
    pub(super) fn calm_down(&mut self, poses: [&BodyPose; 2], scale: TravelScale, allowed: f32, moved: f32) {
        let way = allowed * CALM_SHARE - moved;
        self.calm_until = travel(poses).wrapping_add(scale.travelled(way));
        // Separations are followed by the solver, if there are any.
        let is_followed = self.manifold.count == 0 && self.may_be_calm();
        self.flags.set(ContactFlags::CALM, is_followed);
    }
}

/// The sum of both bodies' travels.
#[inline(always)]
fn travel([a, b]: [&BodyPose; 2]) -> u32 {
    a.travel.wrapping_add(b.travel)
}

impl<S> NarrowPhaseInput<'_, S> {
    /// Whether a contact needs no look. Its separations have to be stored again until the next time.
    #[inline(always)]
    pub(super) fn is_calm(&self, contact: &mut Contact, poses: [&BodyPose; 2]) -> bool {
        let flags = contact.flags;
        if !flags.has(ContactFlags::CALM) {
            return false;
        }
        let touches = flags.has(ContactFlags::TOUCHING);
        contact.flags.set(ContactFlags::CALM, !touches);
        let speed = poses[0].speed + poses[1].speed;
        let left = contact.calm_until.wrapping_sub(travel(poses)) as i32;
        let is_near = speed * self.dt < self.bodies.travel_scale.way_of(left);
        if !(is_near && self.recycle_distance > 0.0) || contact.revisions != self.revisions(contact, poses) {
            return false;
        }
        if !touches {
            return true;
        }
        let is_turned = |side: usize, flag| flags.has(flag) && poses[side].speed != 0.0;
        if is_turned(0, ContactFlags::PLATFORM_A) || is_turned(1, ContactFlags::PLATFORM_B) {
            return false;
        }
        self.sliding_side(contact).is_none()
    }
}
