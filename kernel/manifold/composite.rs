//! Contact manifolds of composite shapes: part by part, without the edges inside a surface, merged into few.
//!
//! A facet alone ends at its borders, the surface does not. So a normal that leans over a border towards the neighbour is
//! replaced by the facet's own: there the neighbour is nearer (convex edges keep the normals between both facets).

use super::dim::{Border, Convex, borders, face_normal, few_points, with_convex};
use super::screen::{Gaps, LANES, Screen};
use super::{FeatureCache, LocalManifold, LocalPoint, collide};
use crate::math::{F32x4, Lane, Pose, Vector, max, min};
use crate::shape::{Aabb, Composite, NO_FACET, Part, Shape, Surface};

/// Manifolds with normals closer than this are merged: cos 2°. More merges slopes; less solves a plane several times.
const SAME_NORMAL: f32 = 0.9994;
/// The same for round shapes, squared, in radians: their points move with the normal, and a point beside the lowest one
/// brakes what rolls.
const SAME_ROUND_NORMAL: f32 = 1.0e-8;
/// Manifolds of curved shapes are merged if their radii differ by less than this share, as they do by less than 2°.
const SAME_RADIUS: f32 = 0.02;

/// Normals that lean over a border by less than this are the facet's own, in radians. More brakes sliding bodies; rounding is
/// a tenth of it.
const LEAN: f32 = 1.0e-3;

/// Normals whose cosine to a face is below this do not tell on which side of it the other shape is.
const SIDEWAYS: f32 = 0.05;

/// A shape is on one side of a face if it reaches to the other side by less than this share of its extent. More turns
/// bodies over that reach under a facet from aside; less pulls cones into faces that they stand on.
const ON_ONE_SIDE: f32 = 0.25;

/// Contacts up to this share of a facet's size inside of a border are on the border.
const ON_BORDER: f32 = 0.02;

/// Points closer than this share of a manifold's size are one.
const SAME_POINT: f32 = 0.01;

/// A facet rises from its deepest point if the separation grows by more than this share of the distance. Points up there do
/// not tell which border is met.
const RISING: f32 = 0.05;

/// The maximum number of rounds of a cast. A pair that needs more meets where the last round placed it.
const MAX_ROUNDS: usize = 16;

/// Parts meet at a gap of this share of the prediction. More stops bodies that pass by; less takes more rounds.
const MET: f32 = 0.1;

/// Normals differ if their cosine is below this: 8°.
const TURNED: f32 = 0.99;
/// A face is deeper than what was found from this share of the prediction on. Less is rounding.
const DEEPER: f32 = 0.005;
/// Rounding and clipping of the depth of a corner that pokes into a seam, as a share of the prediction.
const POKE: f32 = 0.25;
/// The least cosine between a face and the side of a corner that pokes into it.
const MOST_LEAN: f32 = 0.25;

/// Buffers for the manifolds of composite shapes, kept between calls.
#[derive(Clone, Debug, Default)]
pub struct CompositeBuffers {
    parts: Vec<u32>,
    found: Vec<LocalManifold>,
    /// For each of `found` what it replaced, if it is doubtful.
    doubts: Vec<Option<Doubt>>,
    /// For each of `found` the merged manifold it belongs to.
    groups: Vec<usize>,
    points: Vec<LocalPoint>,
}

/// A contact that was replaced by that of the facet's own face, which is deeper or turned. It may be the right one.
#[derive(Clone, Copy, Debug)]
struct Doubt {
    normal: Vector,
    /// The least separation.
    nearest: f32,
    /// The share of the motion after which the facet meets the other shape.
    share: f32,
    /// Whether the face's contact is dropped.
    is_needless: bool,
}

/// How far two shapes are looked at.
#[derive(Clone, Copy, Debug)]
pub struct Look<'a> {
    /// Points up to this distance are found, in metres.
    pub prediction: f32,
    /// How far B moves against A until the end of the step, in A's frame. Parts farther away than the prediction are followed to
    /// where they meet.
    pub motion: Vector,
    /// The group of each facet of A and of B; facets beyond the list have 0. Manifolds of different groups are not merged.
    pub groups: [&'a [u8]; 2],
}

impl Look<'_> {
    /// All facets of both shapes in one group.
    pub const ALIKE: [&'static [u8]; 2] = [&[]; 2];

    /// The group of a part of one side.
    fn group(&self, side: usize, part: u32) -> u8 {
        self.groups[side].get(part as usize).copied().unwrap_or(0)
    }
}

/// A composite shape against a convex one, or against a part of another composite.
#[derive(Clone, Copy)]
struct Pass<'a> {
    composite: &'a Composite<Shape>,
    other: &'a Convex<'a>,
    /// The other shape in the composite's frame.
    pose: &'a Pose,
    /// How far to look; the motion is that of the other shape.
    look: Look<'a>,
    /// The group of the other shape.
    other_group: u8,
    /// Tells the features of several passes apart.
    name: u32,
    /// Whether each part is collided as if it were the only one, up to the end of the motion.
    alone: bool,
}

/// Adds the manifolds of two shapes of which at least one is composite, in A's frame; see [`collide`](super::collide). Returns a
/// lower bound of the distance between the shapes: infinite if no part is near, 0 if there are points.
pub fn collide_composite(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    look: Look<'_>,
    buffers: &mut CompositeBuffers,
    out: &mut Vec<LocalManifold>,
) -> f32 {
    let gap = collide_parts(a, b, pose_b_in_a, look, false, buffers);
    merge(buffers, out);
    if buffers.found.is_empty() { gap } else { 0.0 }
}

/// Adds the manifolds of all parts, each as if it were alone, in A's frame: of those within the prediction, and of those that the
/// motion may meet. Their normals and separations are slabs between convex shapes.
pub fn collide_each_part(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    look: Look<'_>,
    buffers: &mut CompositeBuffers,
    out: &mut Vec<LocalManifold>,
) {
    collide_parts(a, b, pose_b_in_a, look, true, buffers);
    out.extend_from_slice(&buffers.found);
}

/// Fills `buffers.found` with the manifolds of parts. Returns a lower bound of the distance to parts without.
fn collide_parts(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    look: Look<'_>,
    alone: bool,
    buffers: &mut CompositeBuffers,
) -> f32 {
    buffers.found.clear();
    buffers.doubts.clear();
    let is_usable = pose_b_in_a.position.is_finite() && pose_b_in_a.rotation.is_finite();
    if !(is_usable && look.prediction.is_finite() && look.motion.is_finite()) {
        return 0.0;
    }
    match (a, b) {
        (Shape::Composite(a), Shape::Composite(b)) => collide_both([a, b], pose_b_in_a, look, alone, buffers),
        (Shape::Composite(composite), other) => with_other(composite, other, |other| {
            let pass = Pass { composite, other, pose: pose_b_in_a, look, other_group: 0, name: 0, alone };
            pass.collide(buffers)
        }),
        (other, Shape::Composite(composite)) => {
            let pose = pose_b_in_a.inverse();
            let motion = pose_b_in_a.rotation.inverse_rotate(-look.motion);
            let look = Look { motion, groups: [look.groups[1], look.groups[0]], ..look };
            let gap = with_other(composite, other, |other| {
                Pass { composite, other, pose: &pose, look, other_group: 0, name: 0, alone }.collide(buffers)
            });
            buffers.found.iter_mut().for_each(|m| *m = m.flipped(&pose));
            gap
        }
        _ => {
            debug_assert!(false, "one of the shapes is composite");
            0.0
        }
    }
}

/// Calls `f` with a shape that is to be collided with the parts of a composite.
fn with_other<R>(composite: &Composite<Shape>, other: &Shape, f: impl FnOnce(&Convex) -> R) -> R {
    match composite.surface() {
        Some(_) => with_convex(other, f),
        None => f(&Convex::of(other)),
    }
}

/// Two composites: each part of B that is near A against all of A.
fn collide_both(
    [a, b]: [&Composite<Shape>; 2],
    pose: &Pose,
    look: Look<'_>,
    alone: bool,
    buffers: &mut CompositeBuffers,
) -> f32 {
    let (bounds, inverse) = (a.tree().bounds(), pose.inverse());
    let around = bounds.rotated(inverse.rotation);
    let near = Aabb { min: around.min + inverse.position, max: around.max + inverse.position };
    let mut parts = Vec::new();
    b.tree().query(&near.grown(look.prediction + look.motion.length()), |part| parts.push(part));
    // Parts of B that are not near are beyond what was looked at.
    let beyond = if parts.len() < b.len() { look.prediction + look.motion.length() } else { f32::INFINITY };
    parts.iter().fold(beyond, |gap, part| {
        let pass = |other: &Shape, pose: &Pose, buffers: &mut CompositeBuffers| {
            let other_group = look.group(1, *part);
            with_other(a, other, |other| {
                Pass { composite: a, other, pose, look, other_group, name: part + 1, alone }.collide(buffers)
            })
        };
        let here = match b.part(*part) {
            Part::Facet(facet) => pass(&Shape::from(facet), pose, buffers),
            Part::Solid(at, solid) => pass(solid, &pose.then(at), buffers),
        };
        min(gap, here)
    })
}

impl Pass<'_> {
    /// Adds the manifolds of all parts to `buffers.found`, in the composite's frame. Returns a lower bound of the distance to
    /// those without.
    fn collide(&self, buffers: &mut CompositeBuffers) -> f32 {
        let around = self.other.shape.local_box(self.pose);
        let mut parts = core::mem::take(&mut buffers.parts);
        parts.clear();
        let near = around.swept(self.look.motion).grown(self.look.prediction);
        self.composite.tree().query(&near, |part| parts.push(part));
        let mut gap = f32::INFINITY;
        let start = buffers.found.len();
        match self.composite.surface() {
            Some(surface) if !parts.is_empty() => {
                let screen = Screen::new(self.other.shape, self.pose, &around, self.look.motion);
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
        if buffers.found.len() == start && !self.alone {
            // Who only asks whether shapes touch does not need to know how far others are.
            if self.look.prediction <= 0.0 {
                return 0.0;
            }
            return self.composite.tree().gap_beyond(&near, &around, gap);
        }
        self.drop_doubtful(start, buffers);
        gap
    }

    /// The first `count` of four facets that may be near or may be met, as bits, and the least gap of the others.
    #[inline(always)]
    fn split(&self, gaps: &Gaps, count: usize) -> (u32, f32) {
        let Look { prediction, motion, .. } = self.look;
        let far = F32x4::splat(prediction).lt(gaps.now);
        let far = if self.alone {
            F32x4::and(far, F32x4::splat(prediction).lt(gaps.ever))
        } else if motion != Vector::ZERO {
            F32x4::and(far, F32x4::splat(MET * prediction).lt(gaps.ever))
        } else {
            far
        };
        let least = F32x4::select(far, gaps.now, F32x4::splat(f32::INFINITY));
        let least = min(min(least.get(0), least.get(1)), min(least.get(2), least.get(3)));
        (!F32x4::bits(far) & 0xf >> (LANES - count), least)
    }

    /// Drops doubtful contacts from `buffers.found[start..]` that others make needless.
    fn drop_doubtful(&self, start: usize, buffers: &mut CompositeBuffers) {
        let CompositeBuffers { found, doubts, .. } = buffers;
        for i in start..found.len() {
            if let Some(doubt) = doubts[i] {
                let is_needless = self.is_needless(&doubt, &found[i], &found[start..], &doubts[start..]);
                doubts[i] = Some(Doubt { is_needless, ..doubt });
            }
        }
        let is_kept = |doubt: &Option<Doubt>| !doubt.is_some_and(|doubt| doubt.is_needless);
        let mut all = doubts.iter();
        found.retain(|_| all.next().is_some_and(is_kept));
        doubts.retain(is_kept);
    }

    /// Whether a doubtful contact is needless, because one without doubt bears the same. The side facets of a block on a wide floor
    /// overlap it by half its width, and the bottom's contact bears the block. An edge that pokes into a wall at a seam is different:
    /// both facets there are doubtful, so the wall's face stays unless another contact has the replaced normal.
    fn is_needless(
        &self,
        doubt: &Doubt,
        own: &LocalManifold,
        found: &[LocalManifold],
        doubts: &[Option<Doubt>],
    ) -> bool {
        let Look { prediction, motion, .. } = self.look;
        let at_meeting = |m: &LocalManifold| m.lower_bound() + m.normal.dot(motion) * doubt.share;
        // A corner with the replaced normal is deeper in the face by 1 / cos. Contacts met later have no corner in the face yet.
        let (depth, slack) = (own.lower_bound(), POKE * prediction);
        let cos = max(own.normal.dot(doubt.normal), MOST_LEAN);
        let deepest = min(doubt.nearest, doubt.nearest / cos);
        let is_corner = doubt.share == 0.0 && deepest - slack <= depth && depth <= doubt.nearest + slack;
        let certain = || found.iter().zip(doubts).filter(|(_, doubt)| doubt.is_none()).map(|(m, _)| m);
        let has_normal = |m: &LocalManifold| !is_corner || m.normal.dot(doubt.normal) > TURNED;
        certain().any(|m| has_normal(m) && at_meeting(m) <= prediction)
            && !certain().any(|m| m.normal.dot(own.normal) > SAME_NORMAL)
    }

    /// Adds the manifold of one part, if it has one. `screened` are lower bounds of its distance, now and during the motion.
    /// Returns a lower bound of the distance if the part has no manifold, else infinity.
    fn add_part(&self, part: u32, screened: Option<[f32; 2]>, buffers: &mut CompositeBuffers) -> f32 {
        let Look { prediction, motion, .. } = self.look;
        let [now, ever] = screened.unwrap_or([-1.0; 2]);
        let (is_moving, mut local) = (motion != Vector::ZERO, LocalManifold::default());
        let mut gap = f32::INFINITY;
        let mut doubt = None;
        if self.alone {
            self.collide_alone(part, prediction + motion.length(), &mut local);
        } else if now > prediction {
            local.gap = now;
        } else {
            doubt = self.collide_part(part, prediction, &mut local);
        }
        if local.count == 0 {
            gap = local.gap;
            let may_meet = !self.alone && is_moving && !(ever > MET * prediction);
            if may_meet {
                doubt = self.cast(part, &mut local);
            }
            if local.count == 0 {
                return gap;
            }
        }
        let count = local.count;
        local.groups = [self.look.group(0, part), self.other_group];
        local.points[..count].iter_mut().for_each(|p| p.feature = mix([self.name, part, p.feature]));
        buffers.found.push(local);
        buffers.doubts.push(doubt);
        gap
    }

    /// Fills `local` with the contact of one part. Returns what it replaced, if it is doubtful.
    fn collide_part(&self, part: u32, prediction: f32, local: &mut LocalManifold) -> Option<Doubt> {
        self.collide_alone(part, prediction, local);
        let surface = self.composite.surface().filter(|_| local.count > 0);
        surface.and_then(|surface| self.keep_on_surface(surface, part, prediction, local))
    }

    /// Fills `local` with the contact of one part as if there were no other.
    fn collide_alone(&self, part: u32, prediction: f32, local: &mut LocalManifold) {
        match (self.composite.surface(), self.composite.solids().get(part as usize)) {
            (Some(surface), _) => {
                self.other.collide_facet(surface.corners(part), self.pose, prediction, local);
            }
            (None, Some((at, solid))) => {
                let pose = at.inverse().then(self.pose);
                collide(solid, self.other.shape, &pose, prediction, &mut FeatureCache::NONE.clone(), local);
                local.normal = at.rotation.rotate(local.normal);
                local.points[..local.count].iter_mut().for_each(|p| p.point = at.transform(p.point));
            }
            (None, None) => local.count = 0,
        }
    }

    /// Follows the motion to where a part that is farther away than the prediction meets the other shape. `local` receives the
    /// contact there, with the separations of now, if they meet. Returns what it replaced, if it is doubtful.
    fn cast(&self, part: u32, local: &mut LocalManifold) -> Option<Doubt> {
        let way = self.look.motion;
        let met = MET * self.look.prediction;
        let mut share = 0.0;
        for round in 1..=MAX_ROUNDS {
            let pose = Pose { position: self.pose.position + way * share, ..*self.pose };
            let there = Pass { pose: &pose, ..*self };
            there.collide_alone(part, (1.0 - share) * way.length() + self.look.prediction, local);
            let closing = -local.normal.dot(way);
            // A plane between convex shapes that does not close is never crossed.
            if local.count == 0 || !(closing > 0.0) {
                break;
            }
            let gap = local.lower_bound();
            if gap <= met || round == MAX_ROUNDS {
                let doubt = there.collide_part(part, self.look.prediction, local);
                let along = local.normal.dot(way) * share;
                local.closing = -along;
                let count = local.count;
                for p in &mut local.points[..count] {
                    // The point is on the other shape, at that shape's current pose.
                    p.point -= way * share - local.normal * (0.5 * along);
                    p.separation -= along;
                }
                return doubt.map(|doubt| Doubt { share, ..doubt });
            }
            share += max(gap, met) / closing;
            if !(share <= 1.0) {
                break;
            }
        }
        local.count = 0;
        None
    }

    /// A facet's face on the side where the other shape is. The normal of a contact with a border tells little of it: under the
    /// leaning side of a cone that stands on the face it points into the face.
    fn toward_other(&self, corner: Vector, face: Vector, normal: Vector) -> Vector {
        let height = |direction: Vector| {
            let lowest = self.other.shape.support(self.pose.rotation.inverse_rotate(-direction))?;
            Some((self.pose.transform(lowest) - corner).dot(direction))
        };
        // The lowest height of the shape over the face, and over its back: negative where it reaches through.
        let (Some(over), Some(under)) = (height(face), height(-face)) else {
            return if normal.dot(face) < 0.0 { -face } else { face };
        };
        let along = normal.dot(face);
        let is_under = if along.abs() <= SIDEWAYS {
            over < under
        } else if along < 0.0 {
            over <= ON_ONE_SIDE * under
        } else {
            under > ON_ONE_SIDE * over
        };
        if is_under { -face } else { face }
    }

    /// Replaces a facet's manifold by that of its face if its normal leans over a border where the surface goes on. Returns
    /// what it replaced if the face is deeper or turned by more than 8°.
    fn keep_on_surface(
        &self,
        surface: &Surface,
        facet: u32,
        prediction: f32,
        local: &mut LocalManifold,
    ) -> Option<Doubt> {
        let corners = surface.corners(facet);
        let face = face_normal(corners)?;
        let across = local.normal - face * local.normal.dot(face);
        if across.length_squared() < LEAN * LEAN {
            return None;
        }
        let borders = borders(corners, face);
        let (mut leans, mut is_free) = (false, true);
        for (border, neighbor) in borders.iter().zip(surface.neighbors(facet)) {
            if !(local.normal.dot(border.outward) > LEAN) {
                continue;
            }
            leans = true;
            if border.is_met_by(local) {
                is_free &= neighbor == NO_FACET || {
                    let beyond = border.toward_neighbor(surface.corners(neighbor));
                    !(local.normal.dot(beyond) > LEAN)
                };
            }
        }
        // A normal that leans over a border without points there belongs to no feature of the facet.
        let is_met = || borders.iter().any(|b| local.normal.dot(b.outward) > LEAN && b.is_met_by(local));
        if !leans || (is_free && is_met()) {
            return None;
        }
        let (found, nearest) = (local.normal, local.lower_bound());
        let own = self.toward_other(corners[0], face, found);
        self.other.collide_face(corners, own, self.pose, prediction, local);
        let is_doubtful = own.dot(found) < TURNED || local.lower_bound() < nearest - DEEPER * prediction;
        is_doubtful.then_some(Doubt { normal: found, nearest, share: 0.0, is_needless: false })
    }
}

impl Border {
    /// Whether all points of a manifold are on the facet's border, but for those where it rises.
    fn is_met_by(&self, local: &LocalManifold) -> bool {
        let deepest = local.points().iter().min_by(|p, q| p.separation.total_cmp(&q.separation));
        let Some(deepest) = deepest else { return true };
        local.points().iter().all(|p| {
            let on_facet = p.point - local.normal * (0.5 * p.separation);
            let is_above = p.separation - deepest.separation > RISING * (p.point - deepest.point).length();
            is_above || (self.corner - on_facet).dot(self.outward) <= ON_BORDER * self.depth
        })
    }

    /// The direction from the border into the neighbour's plane, across the border.
    fn toward_neighbor<const N: usize>(&self, corners: [Vector; N]) -> Vector {
        let across = corners.map(|corner| {
            let to = corner - self.corner;
            to - self.along * to.dot(self.along)
        });
        let farthest = across
            .into_iter()
            .fold(Vector::ZERO, |f, v| if v.length_squared() > f.length_squared() { v } else { f });
        let length = farthest.length();
        if length > 0.0 { farthest * (1.0 / length) } else { self.outward }
    }
}

/// Merges the manifolds in `buffers.found` with the same groups and about the same normal, the deepest first, and adds the results to `out`.
fn merge(buffers: &mut CompositeBuffers, out: &mut Vec<LocalManifold>) {
    let CompositeBuffers { found, groups, points, .. } = buffers;
    if let [only] = &found[..] {
        out.push(*only);
        return;
    }
    let depth = |m: &LocalManifold| m.points().iter().fold(f32::INFINITY, |low, p| min(low, p.separation));
    found.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    groups.clear();
    let start = out.len();
    for m in found.iter() {
        let is_round_alike = |o: &LocalManifold| {
            o.radii.iter().zip(m.radii).all(|(r, q)| (r - q).abs() <= SAME_RADIUS * max(*r, q))
        };
        let is_flat = m.radii == [0.0; 2];
        let is_parallel = |o: &LocalManifold| match is_flat {
            true => o.radii == m.radii && o.normal.dot(m.normal) > SAME_NORMAL,
            false => (o.normal - m.normal).length_squared() < SAME_ROUND_NORMAL && is_round_alike(o),
        };
        let is_same = |o: &LocalManifold| o.groups == m.groups && is_parallel(o);
        let group = out[start..].iter().position(is_same);
        groups.push(group.unwrap_or(out.len() - start));
        if group.is_none() {
            out.push(*m);
        }
    }
    for (group, merged) in out[start..].iter_mut().enumerate() {
        if groups.iter().filter(|g| **g == group).count() == 1 {
            continue;
        }
        points.clear();
        for (m, _) in found.iter().zip(groups.iter()).filter(|(_, g)| **g == group) {
            points.extend_from_slice(m.points());
        }
        drop_twins(points);
        few_points(points, merged);
    }
}

/// Drops points in the place of an earlier one.
fn drop_twins(points: &mut Vec<LocalPoint>) {
    let first = points[0].point;
    let spread = points.iter().fold(0.0, |far, p| max(far, (p.point - first).length_squared()));
    let mut kept = 0;
    for i in 0..points.len() {
        let point = points[i];
        let is_near =
            |p: &LocalPoint| (p.point - point.point).length_squared() <= SAME_POINT * SAME_POINT * spread;
        match points[..kept].iter().position(is_near) {
            Some(twin) if point.separation < points[twin].separation => points[twin] = point,
            Some(_) => {}
            None => {
                points[kept] = point;
                kept += 1;
            }
        }
    }
    points.truncate(kept);
}

/// One number of three: features only need to be told apart, and to be the same in the next step.
fn mix(words: [u32; 3]) -> u32 {
    words.into_iter().fold(0, |hash: u32, word| (hash.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9))
}
