//! The parts of a composite shape that are near one convex shape, each with its contact.
//!
//! A facet ends at its borders, but the surface continues. So a normal that leans over a border towards the
//! neighbour is replaced by the facet's own normal: there the neighbour is nearer (convex edges keep the
//! normals between both facets).

use super::dim::{Convex, borders, face_normal};
use super::pairs::collide_pair;
use super::screen::{Gaps, LANES, Screen};
use super::{FeatureCache, LocalManifold, ManifoldQuery, PairInput};
use crate::distance::{Approach, advance};
use crate::math::{DIM, F32x4, Lane, MAX_POINTS, Pose, Vector, max, min};
use crate::shape::{Aabb, Composite, NO_FACET, Shape, Surface};
use crate::tuning::manifold::{FACING, MARGIN, POKE, SAME, SAME_NORMAL, SIDEWAYS, TURNED};
use crate::tuning::sweeps::{AHEAD, MET, ROUNDS};
use core::cell::Cell;

/// Up to this number of vertices, the farthest vertex is searched exactly, for each facet that may be on the
/// wrong side.
const FEW_VERTICES: usize = 64;

/// Buffers, kept between calls.
#[derive(Clone, Debug, Default)]
pub(super) struct PartBuffers {
    parts: Vec<u32>,
    pub(super) found: Vec<LocalManifold>,
    /// For each manifold that the present query found, the contact that it replaced, if it is uncertain.
    replaced_contacts: Vec<Option<ReplacedContact>>,
    /// Near parts that the motion may lead past, with their present contacts.
    passing: Vec<(u32, LocalManifold, Option<ReplacedContact>)>,
    /// A lower bound of the distance to parts that are passed by.
    pub(super) passed: f32,
}

impl PartBuffers {
    pub(super) fn clear(&mut self) {
        self.found.clear();
        self.replaced_contacts.clear();
        self.passed = f32::INFINITY;
    }
}

/// A contact that a deeper or turned face contact replaced. It may be the right one: the face contact is
/// uncertain until the contacts of other parts decide.
#[derive(Clone, Copy, Debug)]
struct ReplacedContact {
    normal: Vector,
    /// The least separation of the replaced contact.
    nearest: f32,
    /// The share of the motion after which the facet meets the other shape.
    share: f32,
}

impl ReplacedContact {
    /// A contact of a normal and least separation, if the face contact that replaced it, with a normal and
    /// least separation too, is uncertain.
    fn new(normal: Vector, nearest: f32, by: (Vector, f32), prediction: f32) -> Option<Self> {
        let is_uncertain = by.0.dot(normal) < TURNED || by.1 < nearest - SAME * prediction;
        is_uncertain.then_some(Self { normal, nearest, share: 0.0 })
    }
}

/// The closed surface that a facet is part of.
#[derive(Clone, Copy)]
pub(super) struct ClosedSurface<'a> {
    pub(super) surface: &'a Surface,
    /// The box around it, in its own frame.
    pub(super) around: Aabb,
    /// The facet's outward normal of the closed surface, in the composite's frame.
    pub(super) outward: Vector,
}

impl ClosedSurface<'_> {
    /// The vertex of the surface that is farthest along a direction; for surfaces with many vertices, the
    /// farthest corner of their box.
    fn farthest(&self, direction: Vector) -> Vector {
        if self.surface.vertices().len() <= FEW_VERTICES {
            return self.surface.farthest(direction);
        }
        let half = self.around.half().to_array();
        let along = direction.to_array();
        let corner = core::array::from_fn(|k| if along[k] < 0.0 { -half[k] } else { half[k] });
        self.around.center() + Vector::from_array(corner)
    }
}

/// A composite shape against a convex shape, or against a part of another composite.
#[derive(Clone, Copy)]
pub(super) struct PartQuery<'a> {
    pub(super) composite: &'a Composite<Shape>,
    pub(super) other: &'a Convex<'a>,
    /// The other shape in the composite's frame.
    pub(super) pose: &'a Pose,
    /// The query; its motion is the other shape's.
    pub(super) query: ManifoldQuery<'a>,
    /// The group of the other shape.
    pub(super) other_group: u8,
    /// Distinguishes the features of several part queries.
    pub(super) name: u32,
    /// Whether each part is collided on its own, up to the end of the motion.
    pub(super) alone: bool,
    /// If both shapes move: whether points that are met later lie on the composite at its present pose, not
    /// on the other shape.
    pub(super) on_composite: bool,
    /// Whether the composite is B of the pair. Two solids are then collided in that order, which
    /// prefers faces of A.
    pub(super) is_b: bool,
    /// The cache of the pair, if the composite is one solid.
    pub(super) cache: Option<&'a Cell<FeatureCache>>,
    /// The closed surface, smaller than the composite, that has the other shape as a facet, if any.
    pub(super) closed_surface: Option<ClosedSurface<'a>>,
}

impl<'a> PartQuery<'a> {
    /// A composite against a convex shape.
    pub(super) fn new(
        composite: &'a Composite<Shape>,
        other: &'a Convex<'a>,
        pose: &'a Pose,
        query: ManifoldQuery<'a>,
        alone: bool,
    ) -> Self {
        Self {
            composite,
            other,
            pose,
            query,
            other_group: 0,
            name: 0,
            alone,
            on_composite: false,
            is_b: false,
            cache: None,
            closed_surface: None,
        }
    }

    /// Fills `local` with the contact of a facet's face alone.
    fn collide_face(&self, corners: [Vector; DIM], face: Vector, prediction: f32, local: &mut LocalManifold) {
        let cache = &Cell::new(FeatureCache::NONE);
        self.other.collide_face(corners, face, PairInput { pose: self.pose, prediction, cache }, local);
    }

    /// Adds the manifolds of all parts to `buffers.found`, in the composite's frame. Returns a lower bound of
    /// the distance to parts without a manifold.
    pub(super) fn collide(&self, buffers: &mut PartBuffers) -> f32 {
        let around = self.other.shape.local_box(self.pose);
        let mut parts = core::mem::take(&mut buffers.parts);
        parts.clear();
        let near = around.swept(self.query.motion).grown(self.query.prediction);
        self.composite.tree().query(&near, |part| parts.push(part));
        let mut gap = f32::INFINITY;
        let start = buffers.found.len();
        match self.composite.surface() {
            Some(surface) if !parts.is_empty() => {
                let screen = Screen::new(self.other.shape, self.pose, &around, self.query.motion);
                for few in parts.chunks(LANES) {
                    let gaps = screen.gaps(surface, few);
                    let (mut near, least) = self.split(&gaps, few.len());
                    gap = min(gap, least);
                    while near != 0 {
                        let lane = near.trailing_zeros() as usize;
                        near &= near - 1;
                        let screened = Some([gaps.now.get(lane), gaps.ever.get(lane)]);
                        gap = min(gap, self.add_part(few[lane], screened, buffers));
                    }
                }
            }
            _ => {
                for part in &parts {
                    gap = min(gap, self.add_part(*part, None, buffers));
                }
            }
        }
        buffers.parts = parts;
        if !buffers.passing.is_empty() {
            self.pass_by(start, buffers);
        }
        if buffers.found.len() == start && !self.alone {
            // An overlap test does not need the distance to other parts.
            if self.query.prediction <= 0.0 {
                return 0.0;
            }
            return self.composite.tree().gap_beyond(&near, &around, gap);
        }
        self.drop_redundant(start, buffers);
        gap
    }

    /// Which of the first `count` of four facets may be near or may be met, as bits, and the least gap of the
    /// other facets.
    #[inline(always)]
    fn split(&self, gaps: &Gaps, count: usize) -> (u32, f32) {
        let ManifoldQuery { prediction, motion, .. } = self.query;
        let far = F32x4::splat(prediction).lt(gaps.now);
        let far = if self.alone {
            F32x4::and(far, F32x4::splat(prediction).lt(gaps.ever))
        } else if motion != Vector::ZERO {
            F32x4::and(far, F32x4::splat(self.met_ahead()).lt(gaps.ever))
        } else {
            far
        };
        let least = F32x4::select(far, gaps.now, F32x4::splat(f32::INFINITY));
        let least = min(min(least.get(0), least.get(1)), min(least.get(2), least.get(3)));
        (!F32x4::bits(far) & 0xf >> (LANES - count), least)
    }

    /// Drops uncertain contacts from `buffers.found[start..]` that other contacts make redundant.
    fn drop_redundant(&self, start: usize, buffers: &mut PartBuffers) {
        let PartBuffers { found, replaced_contacts, .. } = buffers;
        for (i, replaced) in (start..).zip(replaced_contacts.iter()) {
            if let Some(replaced) = replaced
                && self.is_redundant(replaced, &found[i], &found[start..], replaced_contacts)
            {
                found[i].count = 0;
            }
        }
        found.retain(|m| m.count > 0);
        replaced_contacts.clear();
    }

    /// Whether an uncertain contact is redundant, because a certain contact bears the same load. The side
    /// facets of a block on a wide floor overlap it by half its width, and the bottom's contact bears the
    /// block. An edge that pokes into a wall at a seam is different: both facets there are uncertain, so the
    /// wall's face stays unless another contact has the replaced normal.
    fn is_redundant(
        &self,
        replaced: &ReplacedContact,
        own: &LocalManifold,
        found: &[LocalManifold],
        replaced_contacts: &[Option<ReplacedContact>],
    ) -> bool {
        let ManifoldQuery { prediction, motion, .. } = self.query;
        let at_meeting = |m: &LocalManifold| m.lower_bound() + m.normal.dot(motion) * replaced.share;
        // A corner with the replaced normal is deeper in the face by a factor of 1 / cos. Contacts met later
        // have no corner in the face yet.
        let (depth, slack) = (own.lower_bound(), POKE * prediction);
        let cos = max(own.normal.dot(replaced.normal), FACING);
        let deepest = min(replaced.nearest, replaced.nearest / cos);
        let is_corner =
            replaced.share == 0.0 && deepest - slack <= depth && depth <= replaced.nearest + slack;
        let certain =
            || found.iter().zip(replaced_contacts).filter(|(_, replaced)| replaced.is_none()).map(|(m, _)| m);
        let has_normal = |m: &LocalManifold| !is_corner || m.normal.dot(replaced.normal) > TURNED;
        // The tread of a step has the floor's normal, but lies in another plane.
        let is_plane = |m: &LocalManifold| {
            m.normal.dot(own.normal) > SAME_NORMAL && at_meeting(m) <= at_meeting(own) + SAME * prediction
        };
        certain().any(|m| has_normal(m) && at_meeting(m) <= prediction) && !certain().any(is_plane)
    }

    /// Adds the manifold of one part, if any. `screened` are lower bounds of its distance, now and during the
    /// motion. Returns a lower bound of the distance if the part has no manifold, otherwise infinity.
    fn add_part(&self, part: u32, screened: Option<[f32; 2]>, buffers: &mut PartBuffers) -> f32 {
        let ManifoldQuery { prediction, motion, .. } = self.query;
        let [now, ever] = screened.unwrap_or([-1.0; 2]);
        let (is_moving, mut local) = (motion != Vector::ZERO, LocalManifold::default());
        let mut gap = f32::INFINITY;
        let mut replaced = None;
        if self.alone {
            self.collide_alone(part, prediction + motion.length(), &mut local);
        } else if now > prediction {
            local.gap = now;
        } else {
            replaced = self.collide_part(part, prediction, &mut local);
            if self.may_pass_by(&local) {
                buffers.passing.push((part, local, replaced));
                return local.lower_bound();
            }
            self.look_ahead(part, &mut local);
        }
        if local.count == 0 {
            gap = local.gap;
            let may_meet = !self.alone && is_moving && !(ever > self.met_ahead());
            if may_meet {
                replaced = self.cast(part, self.met_ahead(), &mut local);
            }
            if local.count == 0 {
                return gap;
            }
        }
        self.push(part, local, replaced, buffers);
        gap
    }

    /// Adds a contact of a part.
    fn push(
        &self,
        part: u32,
        mut local: LocalManifold,
        replaced: Option<ReplacedContact>,
        buffers: &mut PartBuffers,
    ) {
        local.groups = [self.query.group(0, part), self.other_group];
        local.points_mut().for_each(|p| p.feature = mix([self.name, part, p.feature]));
        buffers.found.push(local);
        buffers.replaced_contacts.push(replaced);
    }

    /// Sweeps against the parts that the motion may lead past, unless a touching part stops the motion.
    fn pass_by(&self, start: usize, buffers: &mut PartBuffers) {
        let ManifoldQuery { prediction, motion, met, .. } = self.query;
        let stops = |m: &LocalManifold| m.lower_bound() <= met && -m.normal.dot(motion) > prediction;
        let is_stopped = buffers.found[start..].iter().any(stops);
        let mut passing = core::mem::take(&mut buffers.passing);
        for (part, mut local, mut replaced) in passing.drain(..) {
            let gap = local.lower_bound();
            if is_stopped {
                self.look_ahead(part, &mut local);
            } else {
                replaced = self.cast(part, met, &mut local);
            }
            if local.count > 0 {
                self.push(part, local, replaced, buffers);
            } else {
                buffers.passed = min(buffers.passed, gap);
            }
        }
        buffers.passing = passing;
    }

    /// Fills `local` with the contact of one part. Returns the replaced contact, if the new one is uncertain.
    fn collide_part(&self, part: u32, prediction: f32, local: &mut LocalManifold) -> Option<ReplacedContact> {
        self.collide_alone(part, prediction, local);
        if let Some(closed_surface) = self.closed_surface.filter(|_| local.count > 0) {
            let (normal, nearest) = (local.normal, local.lower_bound());
            self.keep_outside(&closed_surface, part, prediction, local);
            let by = (local.normal, local.lower_bound());
            let replaced = ReplacedContact::new(normal, nearest, by, prediction);
            if replaced.is_some() && local.count > 0 {
                return replaced;
            }
        }
        let surface = self.composite.surface().filter(|_| local.count > 0)?;
        self.keep_on_surface(surface, part, prediction, local)
    }

    /// Whether the motion may lead past a part that has points: it crosses their plane.
    fn may_pass_by(&self, local: &LocalManifold) -> bool {
        let gap = local.lower_bound();
        local.count > 0 && gap > self.query.met && -local.normal.dot(self.query.motion) * AHEAD > gap
    }

    /// The distance at which parts beyond the prediction distance count as met.
    fn met_ahead(&self) -> f32 {
        min(self.query.met, MET * self.query.prediction)
    }

    /// Adds the points of a contact's part that the motion will bring together: a body struck at one point
    /// turns towards the others.
    fn look_ahead(&self, part: u32, local: &mut LocalManifold) {
        let ManifoldQuery { prediction, motion, .. } = self.query;
        let closing = -local.normal.dot(motion);
        if local.count == 0 || local.count == MAX_POINTS || !(closing > prediction) {
            return;
        }
        let mut ahead = LocalManifold::default();
        self.collide_part(part, prediction + closing, &mut ahead);
        if ahead.count > local.count && ahead.normal.dot(local.normal) > SAME_NORMAL {
            *local = ahead;
        }
    }

    /// Fills `local` with the contact of one part on its own.
    fn collide_alone(&self, part: u32, prediction: f32, local: &mut LocalManifold) {
        let none = Cell::new(FeatureCache::NONE);
        match (self.composite.surface(), self.composite.solids().get(part as usize)) {
            (Some(surface), _) => {
                let input = PairInput { pose: self.pose, prediction, cache: &none };
                self.other.collide_facet(surface.corners(part), input, local);
            }
            (None, Some((at, solid))) => {
                let pose = at.inverse().then(self.pose);
                let input = PairInput { pose: &pose, prediction, cache: self.cache.unwrap_or(&none) };
                if self.is_b {
                    let inverse = pose.inverse();
                    collide_pair(self.other.shape, solid, PairInput { pose: &inverse, ..input }, local);
                    *local = local.flipped(&inverse);
                } else {
                    collide_pair(solid, self.other.shape, input, local);
                }
                local.normal = at.rotation.rotate(local.normal);
                local.points_mut().for_each(|p| p.point = at.transform(p.point));
            }
            (None, None) => local.count = 0,
        }
    }

    /// Sweeps to the time of impact: a part and the other shape are then `met` apart. `local` receives the
    /// contact at this time with present separations, if they meet. Returns the replaced contact, if the new
    /// one is uncertain.
    fn cast(&self, part: u32, met: f32, local: &mut LocalManifold) -> Option<ReplacedContact> {
        let way = self.query.motion;
        let mut beside = None;
        let meeting = advance(0.0, ROUNDS, |mut share, round| {
            if !(share <= 1.0) {
                return None;
            }
            let pose = Pose { position: self.pose.position + way * share, ..*self.pose };
            let there = PartQuery { pose: &pose, ..*self };
            there.collide_alone(part, (1.0 - share) * way.length() + self.query.prediction, local);
            let closing = -local.normal.dot(way);
            // A plane between convex shapes that does not close is never crossed.
            if local.count == 0 || !(closing > 0.0) {
                return None;
            }
            let gap = local.lower_bound();
            if gap <= met || round == ROUNDS {
                let normal = local.normal;
                // At an edge the normal turns until the shapes touch.
                share = min(share + max(gap, 0.0) / closing, 1.0);
                let pose = Pose { position: self.pose.position + way * share, ..*self.pose };
                let replaced =
                    PartQuery { pose: &pose, ..*self }.collide_part(part, self.query.prediction, local);
                if local.count > 0
                    && beside.is_none_or(|beside: Vector| beside.dot(local.normal) > SAME_NORMAL)
                {
                    self.bring_back(share, local);
                    return Some(Approach::Met(
                        replaced.map(|replaced| ReplacedContact { share, ..replaced }),
                    ));
                }
                // A shape that meets a facet beside a border may cross the border before it touches: then it
                // meets the neighbour on this side.
                if local.count > 0 || gap < -met {
                    return None;
                }
                beside.get_or_insert(normal);
            }
            Some(Approach::ApartUntil(share + max(gap, met) / closing))
        });
        if meeting.is_none() {
            local.count = 0;
        }
        meeting?
    }

    /// Converts a contact that is met after a share of the motion to present separations.
    fn bring_back(&self, share: f32, local: &mut LocalManifold) {
        let way = self.query.motion * share;
        let along = local.normal.dot(way);
        let half = local.normal * (0.5 * along);
        let on_composite = match self.query.ground {
            [true, false] => false,
            [false, true] => true,
            _ => self.on_composite,
        };
        let back = if on_composite { half } else { way - half };
        for p in local.points_mut() {
            p.point -= back;
            p.separation -= along;
            p.closing = -along;
        }
    }

    /// The face normal of a facet on the side of the other shape. The normal of a border contact does not
    /// tell the side: under the leaning side of a cone that stands on the face it points into the face.
    fn toward_other(&self, corner: Vector, face: Vector, normal: Vector) -> Vector {
        let height = |direction: Vector| {
            let local = self.pose.rotation.inverse_rotate(-direction);
            let lowest = match self.closed_surface {
                Some(closed_surface) => closed_surface.farthest(local),
                None => self.other.shape.support(local)?,
            };
            Some((self.pose.transform(lowest) - corner).dot(direction))
        };
        // The lowest height of the shape over the face and over its back; negative where the shape reaches
        // through.
        let (Some(over), Some(under)) = (height(face), height(-face)) else {
            return if normal.dot(face) < 0.0 { -face } else { face };
        };
        if over < under { -face } else { face }
    }

    /// Replaces a contact that pushes a facet of a closed surface along its outward normal, or through the
    /// composite, by the face contact on the side of the surface. Drops it if the facet is on the surface's
    /// back.
    fn keep_outside(
        &self,
        closed_surface: &ClosedSurface,
        part: u32,
        prediction: f32,
        local: &mut LocalManifold,
    ) {
        let facing = local.normal.dot(closed_surface.outward);
        if facing < -FACING {
            return;
        }
        let is_behind = facing > SIDEWAYS;
        let corners = self.composite.surface().map(|surface| surface.corners(part));
        let own = corners.and_then(|corners| {
            Some((corners, self.toward_other(corners[0], face_normal(corners)?, local.normal)))
        });
        match own {
            None if !is_behind => {}
            Some((_, own)) if !is_behind && !(local.normal.dot(own) < -SIDEWAYS) => {}
            Some((corners, own)) if !(own.dot(closed_surface.outward) > SIDEWAYS) => {
                self.collide_face(corners, own, prediction, local);
            }
            _ => (local.count, local.gap) = (0, max(local.lower_bound(), 0.0)),
        }
    }

    /// Replaces a facet's contact by its face contact if the normal leans over a border where the surface
    /// continues. Returns the replaced contact if the face contact is deeper or turned by more than 8°.
    fn keep_on_surface(
        &self,
        surface: &Surface,
        facet: u32,
        prediction: f32,
        local: &mut LocalManifold,
    ) -> Option<ReplacedContact> {
        let corners = surface.corners(facet);
        let face = face_normal(corners)?;
        let across = local.normal - face * local.normal.dot(face);
        if across.length_squared() < MARGIN * MARGIN {
            return None;
        }
        let borders = borders(corners, face);
        let (mut leans, mut is_free) = (false, true);
        for (border, neighbor) in borders.iter().zip(surface.neighbors(facet)) {
            if !(local.normal.dot(border.outward) > MARGIN) {
                continue;
            }
            leans = true;
            if border.is_met_by(local) {
                is_free &= neighbor == NO_FACET || {
                    let beyond = border.toward_neighbor(surface.corners(neighbor));
                    !(local.normal.dot(beyond) > MARGIN)
                };
            }
        }
        // A normal that leans over a border without points there belongs to no feature of the facet.
        let is_met = || borders.iter().any(|b| local.normal.dot(b.outward) > MARGIN && b.is_met_by(local));
        if !leans || (is_free && is_met()) {
            return None;
        }
        let (found, nearest) = (local.normal, local.lower_bound());
        let own = self.toward_other(corners[0], face, found);
        self.collide_face(corners, own, prediction, local);
        ReplacedContact::new(found, nearest, (own, local.lower_bound()), prediction)
    }
}

/// A hash of three numbers: features only need to be distinct, and the same in the next step.
fn mix(words: [u32; 3]) -> u32 {
    words.into_iter().fold(0, |hash: u32, word| (hash.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9))
}
