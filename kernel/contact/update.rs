//! The narrow phase of one contact: apart? → [recycle](super::recycle)? → the full manifold.

use super::phase::{ManifoldSource, NarrowPhase, smaller};
use super::record::{Contact, ContactFlags, Frozen, Manifold, ManifoldPoint};
use super::recycle::Group;
use super::sweep::Meeting;
use crate::manifold::{self, FeatureCache, LocalManifold};
use crate::math::{Rot, Vector, max, min};
use crate::shape::Shape;
use crate::table::{BodyKind, BodyPose, NONE};

/// Buffers of one worker, kept between steps; `W` are those of its [`ManifoldSource`]. In cache lines of its own, for
/// they are written with every contact.
#[derive(Clone, Debug, Default)]
#[repr(align(128))]
pub struct Scratch<W = ()> {
    local: Vec<LocalManifold>,
    foreign: W,
    /// Contacts that may be recycled.
    pub(super) group: Group,
    /// Where [`NarrowPhase::update`] leaves the manifolds after the first.
    pub extra: Vec<Manifold>,
    /// What the table is to be told when all contacts are updated: which began or ended to touch, ...
    pub(super) changed: Vec<u32>,
    /// ... which have how many manifolds after the first, ...
    pub(super) stored: Vec<(u32, usize)>,
    /// ... these one after the other, ...
    pub(super) pool: Vec<Manifold>,
    /// ... and whether any overlaps deeply.
    pub(super) any_deep: bool,
}

/// What an update found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// The fat boxes do not overlap any more.
    Apart,
    /// The manifold followed the motion.
    Recycled,
    /// The manifold was computed anew.
    Computed,
}

/// Overlap is deep from this share of the smaller side's reach on, where bodies were put into one another. What load or
/// a blow presses together is not: it has to be borne, or a heap would sink into itself.
const DEEP: f32 = 0.1;
/// What was deep stays so down to this share: overlap that has begun to be pushed out gently is so to its
/// end. Were it the share above, the last tenth would be pushed out as by springs, and a row of a hundred
/// bodies would fly apart.
const NO_LONGER_DEEP: f32 = 0.01;

/// What is known of a contact at first sight.
pub(super) enum Begun {
    /// The fat boxes do not overlap any more.
    Apart,
    /// It is in the group, and may be recycled.
    Asked,
    /// Its manifold is to be computed anew.
    Stale,
}

impl<S: ManifoldSource> NarrowPhase<'_, S> {
    /// Brings one contact alone up to date with where its bodies are now, as [`ContactTable`](super::ContactTable) does all.
    /// `crowded` says that one of them overlapped another deeply before. Manifolds after the first are left in
    /// `scratch.extra`; the caller stores them.
    pub fn update(
        &self,
        contact: &mut Contact,
        extra: &[Manifold],
        crowded: bool,
        scratch: &mut Scratch<S::Workspace>,
    ) -> Found {
        scratch.group.clear();
        match self.begin(0, contact, &mut scratch.group) {
            Begun::Apart => return Found::Apart,
            Begun::Asked => {
                self.answer(&mut scratch.group);
                if scratch.group.apply(0, contact) {
                    self.follow(contact);
                    return Found::Recycled;
                }
            }
            Begun::Stale => {}
        }
        self.renew(contact, extra, crowded, scratch);
        Found::Computed
    }

    /// Looks at a contact first, and puts it in the group if it may be recycled.
    #[inline(always)]
    pub(super) fn begin(&self, id: u32, contact: &Contact, group: &mut Group) -> Begun {
        let [a, b] = contact.colliders;
        if !self.colliders.fat[a as usize].overlaps(&self.colliders.fat[b as usize]) {
            return Begun::Apart;
        }
        let is_asked = self.ask(id, contact, self.poses(contact, &mut [None; 2]), group);
        if is_asked { Begun::Asked } else { Begun::Stale }
    }

    /// What is left to do of a contact that was recycled.
    #[inline(always)]
    pub(super) fn follow(&self, contact: &mut Contact) {
        if contact.flags.has(ContactFlags::DEEP) {
            contact.flags.set(ContactFlags::DEEP, self.overlaps_by(NO_LONGER_DEEP, contact));
        }
    }

    /// Computes the manifolds anew; otherwise as [`update`](Self::update).
    pub(super) fn renew(
        &self,
        contact: &mut Contact,
        extra: &[Manifold],
        crowded: bool,
        scratch: &mut Scratch<S::Workspace>,
    ) {
        let mut fixed = [None; 2];
        let poses = self.poses(contact, &mut fixed);
        // What has just come together, or was changed by hand, was put where it is; all else was pressed there, if not
        // by those that were put there.
        let placed = crowded || contact.revisions != self.revisions(contact, poses);
        let meeting = self.compute(contact, poses, scratch);
        self.replace(contact, extra, poses[0], meeting.as_ref(), scratch);
        let deep = match (contact.flags.has(ContactFlags::DEEP), placed) {
            (true, _) => self.overlaps_by(NO_LONGER_DEEP, contact),
            (false, true) => self.overlaps_by(DEEP, contact),
            (false, false) => false,
        };
        contact.flags.set(ContactFlags::DEEP, deep);
    }

    /// Whether the shapes overlap by more than a share of the smaller one's reach.
    fn overlaps_by(&self, share: f32, contact: &Contact) -> bool {
        let deepest = contact.manifold.points().iter().fold(0.0, |d, p| min(d, p.separation));
        let [a, b] = self.reaches(contact);
        let reach = smaller([a.extent, b.extent]);
        deepest < 0.0 && deepest < -share * reach
    }

    /// Computes the manifolds at the present pose, into `scratch.local`, and freezes the contact there. Where the shapes will
    /// meet only because a body turns, it is the manifold of then.
    fn compute(
        &self,
        contact: &mut Contact,
        poses: [&BodyPose; 2],
        scratch: &mut Scratch<S::Workspace>,
    ) -> Option<Meeting> {
        let [a, b] = contact.colliders;
        let margin = self.margin(contact);
        let revisions = self.revisions(contact, poses);
        if contact.revisions != revisions {
            // What is remembered of the features may be of other shapes.
            contact.cache = FeatureCache::NONE;
        }
        let mut reach = self.prediction(contact);
        let prediction = reach + margin;

        let mut meeting = None;
        scratch.local.clear();
        if contact.flags.has(ContactFlags::FOREIGN) {
            // These can be looked at where they are now only.
            let prediction = self.farthest(contact, reach) + margin;
            self.source.manifolds(a, b, prediction, &mut scratch.foreign, &mut scratch.local);
        } else {
            let mut apart = self.colliders.tight[a as usize].gap(&self.colliders.tight[b as usize]);
            let (sa, sb): (&Shape, &Shape) = (&self.colliders[a].def.shape, &self.colliders[b].def.shape);
            let mut local = LocalManifold::default();
            if !(apart > prediction) || !(apart - margin > self.farthest(contact, reach)) {
                let (pose_a, pose_b) = (&self.colliders.poses[a as usize], &self.colliders.poses[b as usize]);
                let relative = pose_a.relative(pose_b);
                manifold::collide(sa, sb, &relative, prediction, &mut contact.cache, &mut local);
                // Shapes that turn are often much farther apart than their boxes.
                apart = max(apart, local.apart);
                if local.count == 0 {
                    meeting = self.meeting(contact, poses, apart - margin, reach, &mut local);
                }
            }
            if local.count > 0 {
                self.note_platform(contact, [sa, sb]);
                scratch.local.push(local);
            } else {
                reach = max(apart - margin, reach);
            }
        }

        contact.frozen = Frozen {
            rotations: poses.map(|p| p.rotation),
            offset: (poses[1].center - poses[0].center).to_local(),
            prediction: reach,
        };
        contact.revisions = revisions;
        let recyclable =
            self.recycle_distance > 0.0 && !contact.flags.has(ContactFlags::FOREIGN) && meeting.is_none();
        contact.flags.set(ContactFlags::FROZEN, recyclable);
        if let Some(meeting) = meeting {
            contact.frozen.offset = meeting.offset;
        }
        meeting
    }

    /// Notes in the flags which body is a platform. Two round shapes have none, since one can roll under the same normal.
    fn note_platform(&self, contact: &mut Contact, shapes: [&Shape; 2]) {
        let is_platform = |body: u32| body == NONE || self.bodies[body].kind != BodyKind::Dynamic;
        let is_round = |s: &&Shape| matches!(s, Shape::Ball(_) | Shape::Capsule(_) | Shape::Segment(_));
        let are_round = shapes.iter().all(is_round);
        let [a, b] = contact.bodies.map(|body| !are_round && is_platform(body));
        contact.flags.set(ContactFlags::PLATFORM_A, a);
        contact.flags.set(ContactFlags::PLATFORM_B, b && !a);
    }

    /// Puts the manifolds in `scratch.local` in place of those that were, and hands the old points' impulses on. `body_a`
    /// is the pose of the first side's body.
    fn replace(
        &self,
        contact: &mut Contact,
        extra: &[Manifold],
        body_a: &BodyPose,
        meeting: Option<&Meeting>,
        scratch: &mut Scratch<S::Workspace>,
    ) {
        scratch.extra.clear();
        if contact.manifold.count == 0 && scratch.local.is_empty() {
            contact.flags.set(ContactFlags::TOUCHING, false);
            return;
        }
        let [a, b] = contact.colliders;
        let (ca, cb) = (&self.colliders[a].def, &self.colliders[b].def);
        let margin = self.margin(contact);
        let pose_a = meeting.map_or(&self.colliders.poses[a as usize], |meeting| &meeting.pose_a);
        let body_a = meeting.map_or(body_a, |meeting| &meeting.body_a);
        // From body A's centre of mass to collider A's origin, in world axes.
        let to_shape = (pose_a.position - body_a.center).to_local();
        let old = core::mem::take(&mut contact.manifold);
        for (i, local) in scratch.local.iter().enumerate() {
            let mut m = to_world(local, pose_a.rotation, to_shape, margin);
            m.rounding = [ca.shape.rounding(), cb.shape.rounding()];
            if let Some(meeting) = meeting {
                meeting.take_back(&mut m);
            }
            if !m.normal.is_finite()
                || m.points().iter().any(|p| !p.separation.is_finite() || !p.anchor.is_finite())
            {
                continue;
            }
            vary_first(&mut m, contact.colliders);
            if self.match_points {
                inherit(&mut m, core::iter::once(&old).chain(extra.iter()));
            }
            if i == 0 {
                contact.manifold = m;
            } else {
                scratch.extra.push(m);
            }
        }
        let touching = contact.manifold.count > 0 || !scratch.extra.is_empty();
        contact.flags.set(ContactFlags::TOUCHING, touching);
    }
}

/// A manifold in world axes, with anchors from body A's centre of mass.
fn to_world(local: &LocalManifold, rotation: Rot, to_shape: Vector, margin: f32) -> Manifold {
    let mut m =
        Manifold { normal: rotation.rotate(local.normal), count: local.count as u32, ..Manifold::default() };
    for (out, p) in m.points.iter_mut().zip(local.points()) {
        let separation = p.separation - margin;
        *out = ManifoldPoint {
            anchor: to_shape + rotation.rotate(p.point),
            frozen_separation: separation,
            separation,
            impulse: 0.0,
            feature: p.feature,
        };
    }
    m
}

/// Lets different points come first in different contacts; points that follow each other in pairs still do.
///
/// The solver takes points one after the other, which favours some a little. Were those on the same side in
/// every contact, a whole stack would lean to that side as it settles, and sway. So ids choose: by the R₂
/// sequence, which spreads evenly both along ids that count up in one collider and in both (M. Roberts, "The
/// unreasonable effectiveness of quasirandom sequences", 2018), where bits of a sum would follow the rows of
/// a wall.
fn vary_first(m: &mut Manifold, [a, b]: [u32; 2]) {
    // 2³² / ρ and 2³² / ρ², where ρ³ = ρ + 1.
    const R2: [u32; 2] = [0xC13F_A9A9, 0x91E1_0DA6];
    if !m.count.is_power_of_two() {
        return;
    }
    let spread = a.wrapping_mul(R2[0]).wrapping_add(b.wrapping_mul(R2[1])) >> 30;
    let flip = (spread & (m.count - 1)) as usize;
    let old = m.points;
    for i in 0..m.count as usize {
        m.points[i] = old[i ^ flip];
    }
}

/// Hands on the impulses of the old manifold that this one continues: the one whose normal is nearest,
/// points by feature id.
fn inherit<'a>(m: &mut Manifold, old: impl Iterator<Item = &'a Manifold>) {
    /// Manifolds whose normals differ more than this are of another face: cos 25°.
    const SAME_FACE: f32 = 0.9;
    let mut best: Option<(&Manifold, f32)> = None;
    for o in old.filter(|o| o.count > 0) {
        let cos = o.normal.dot(m.normal);
        if cos > SAME_FACE && best.is_none_or(|(_, c)| cos > c) {
            best = Some((o, cos));
        }
    }
    let Some((old, _)) = best else { return };
    let mut any = false;
    for p in &mut m.points[..m.count as usize] {
        if let Some(o) = old.points().iter().find(|o| o.feature == p.feature) {
            p.impulse = o.impulse;
            any = true;
        }
    }
    if any {
        m.friction_impulse = old.friction_impulse;
        m.twist_impulse = old.twist_impulse;
    }
}
