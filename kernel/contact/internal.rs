//! Internal edges: inner edges and sides of pieces that together form one surface.
//!
//! A body that slides over flush tiles, or over the triangles of a mesh, meets the sides and edges of the
//! pieces ahead. Each piece alone is an obstacle; together they are a plane. So the manifolds of a collider
//! are compared. A manifold whose ground points all lie on or below the plane of another manifold is
//! redundant, and is not solved. Points on a kerb, a wall or the far side of a groove lie above that plane. A
//! body that touches a wall only at its foot has no point above the plane: there a probe tests whether the
//! wall continues above it.
//!
//! Only manifolds between moving colliders and ground are compared. Ground is a body that is not dynamic, or
//! a dynamic body at rest. The result depends on positions and velocities, not on the number of threads.

use super::impulse_transfer;
use super::input::{NarrowPhaseInput, smaller};
use super::manifold_update::{self, WorkerBuffers};
use super::record::{Contact, ContactFlags, Manifold, ManifoldPoint, Parallel, Sliding};
use super::table::{ContactTable, PointCount};
use crate::math::{NormalMoment, Rot, Vector, WorldPose, max, min};
use crate::shape::{Ball, Shape};
use crate::thread_pool::ThreadPool;
use crate::tuning::contact::{FLUSH, MOVING, RESTING, RISES, SAME_FACE, SLIDING};
use crate::tuning::manifold::{ALIKE, MARGIN, PARALLEL, SIDEWAYS};

/// Colliders per block of work.
const BLOCK: usize = 16;

/// A manifold in the view of its sliding collider.
struct Seen<'a> {
    manifold: &'a Manifold,
    /// From the ground to the collider.
    normal: Vector,
    /// From the collider's body to the origin of the anchors.
    origin: Vector,
    /// Maximum height of its points above a plane that still counts as flush.
    flush: f32,
    /// Maximum depth of the collider below the supporting plane, beyond that contact's penetration.
    below: f32,
    /// Motion of the collider relative to the ground until they meet; 0 for points at the present pose.
    motion: Vector,
    /// Motion over the whole step, if points of a composite are met at different times; otherwise 0.
    way: Vector,
    place: Place,
}

/// Position of the anchors of shapes that meet later in the step.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Midway between both surfaces, at the meeting pose.
    Meeting,
    /// Half of the separation above the ground's surface.
    Ground,
    /// Half of the separation below the collider's present surface.
    Collider,
    /// At the meeting point, moved back with the collider to its present pose.
    Moved,
}

impl<'a> Seen<'a> {
    fn new(input: &NarrowPhaseInput, contact: &Contact, side: usize, manifold: &'a Manifold) -> Self {
        let mut fixed = [None; 2];
        let sides = input.sides(contact, &mut fixed);
        let (poses, ground) = (sides.poses, 1 - side);
        // Points of a recycled manifold keep their positions on the ground.
        let frozen = if ground == 1 { contact.frozen.offset } else { Vector::ZERO };
        let origin = (poses[ground].center - poses[side].center).to_local() - frozen;
        let sign = if side == 0 { -1.0 } else { 1.0 };
        let ([a, b], shapes) = (sides.reaches(), sides.shapes());
        let is_curved = shapes.iter().any(|shape| matches!(shape, Shape::Curved(_)));
        let is_clipped =
            manifold.radii == [0.0; 2] || is_curved || !shapes.iter().any(|shape| is_line(shape));
        let clipped = if is_clipped { MARGIN * smaller([a.extent, b.extent]) } else { 0.0 };
        let is_recycled = contact.flags.has(ContactFlags::FROZEN);
        let until_met = if is_recycled { Vector::ZERO } else { contact.frozen.offset - sides.offset() };
        let (mut way, mut place) = (Vector::ZERO, Place::Meeting);
        let is_met_later = |p: &ManifoldPoint| p.separation != p.frozen_separation;
        if contact.flags.has(ContactFlags::COMPOSITE)
            && !is_recycled
            && manifold.points().iter().any(is_met_later)
        {
            way = sides.predicted_motion() * sign;
            let is_dynamic = sides.are_dynamic();
            let placed_on = usize::from(matches!(shapes[0], Shape::Composite(_)));
            place = match is_dynamic {
                [true, true] if placed_on == side => Place::Collider,
                [true, true] => Place::Ground,
                _ if is_dynamic[side] => Place::Moved,
                _ => Place::Meeting,
            };
        }
        let flush = FLUSH * input.bodies.length_unit() + clipped;
        let (below, motion) = (input.tolerance, until_met * sign);
        Self { manifold, normal: manifold.normal * sign, origin, flush, below, motion, way, place }
    }

    /// Motion of the collider until a point is met.
    fn motion(&self, p: &ManifoldPoint) -> Vector {
        let share = (p.separation - p.frozen_separation) / -self.normal.dot(self.way);
        // Motion along the plane hardly closes the gap: the share is at most the whole step.
        if share > 0.0 { self.motion + self.way * min(share, 1.0) } else { self.motion }
    }

    /// Pairs of a point on the ground and the opposite point on the collider, at the meeting pose.
    fn points(&self) -> impl Iterator<Item = [Vector; 2]> + '_ {
        self.manifold.points().iter().map(|p| {
            let motion = self.motion(p);
            let (middle, gap) = (self.origin + p.anchor, self.normal * p.frozen_separation);
            let half = self.normal * (0.5 * p.separation);
            let ground = match self.place {
                Place::Meeting => middle - gap * 0.5,
                Place::Ground => middle - half,
                Place::Collider => middle + half + motion - gap,
                Place::Moved => middle + motion - gap * 0.5,
            };
            [ground, ground + gap]
        })
    }

    /// Height of the highest ground point along a direction.
    fn top(&self, direction: Vector) -> f32 {
        self.points().fold(f32::NEG_INFINITY, |top, [p, _]| max(top, p.dot(direction)))
    }

    /// The plane's height along its normal.
    fn plane(&self) -> f32 {
        self.top(self.normal)
    }

    /// Minimum height of a plane, with a normal of the group, for all points of this manifold to be flush
    /// with it.
    fn least_top(&self, group: &Parallel) -> f32 {
        let (mut top, mut reach): (f32, f32) = (f32::NEG_INFINITY, 0.0);
        for [p, _] in self.points() {
            (top, reach) = (max(top, p.dot(group.normal)), max(reach, p.length_squared()));
        }
        let rounding = if group.spread > 0.0 { group.spread + 8.0 * f32::EPSILON } else { 0.0 };
        top - self.flush - rounding * reach.sqrt()
    }

    /// Whether `other`, which is not parallel, already prevents every motion that this manifold prevents. At
    /// a seam, with the points of both on each other's planes, only if the plane of `other` continues over
    /// both pieces.
    fn is_held_by(&self, other: &Seen, is_plane_of_both: impl FnOnce() -> bool) -> bool {
        let highest = self.top(other.normal) - other.plane();
        if !(highest <= self.flush) {
            return false;
        }
        let of_other = other.top(self.normal) - self.plane();
        if !(highest < of_other || of_other >= -self.flush && is_plane_of_both()) {
            return false;
        }
        let nearest = other.manifold.points().iter().fold(f32::INFINITY, |s, p| min(s, p.separation));
        let lowest = self.points().zip(self.manifold.points()).fold(f32::INFINITY, |low, ([_, own], p)| {
            // Until they meet, the collider moves down to the plane, not into it.
            let down = self.motion(p).dot(other.normal);
            min(low, own.dot(other.normal) + max(-max(nearest, 0.0) - down, 0.0))
        });
        lowest - other.plane() >= min(nearest, 0.0) - self.below
    }
}

/// Classifies a manifold against the collider's other manifolds.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    /// Stops the collider.
    Obstacle,
    /// Redundant: another manifold prevents the same motion.
    Internal,
    /// Stops the collider along another normal: the normal of a nearly parallel plane or, where its own
    /// normal points down at a wall, the component of its own normal along the plane.
    Turned(Vector),
}

impl Sliding {
    /// Whether another manifold of the collider has the same normal, within the tolerance.
    #[inline(always)]
    fn is_parallel(&self, other: &Self) -> bool {
        let apart = self.normal - other.normal;
        let squared = apart.length_squared();
        if !(self.is_round && other.is_round && squared < PARALLEL * PARALLEL) || self.is_face {
            return squared < PARALLEL * PARALLEL;
        }
        // The contact point of round shapes moves with the normal; two points move only across their line.
        (apart - self.line * apart.dot(self.line)).length_squared() < ALIKE * ALIKE
    }
}

/// Whether a shape is a point or segment with a radius: it has no faces to clip.
fn is_line(shape: &Shape) -> bool {
    matches!(shape, Shape::Ball(_) | Shape::Capsule(_) | Shape::Segment(_))
}

/// The unit vector along `v`; 0 for the zero vector.
fn unit(v: Vector) -> Vector {
    let length = v.length();
    if length > 0.0 { v * (1.0 / length) } else { Vector::ZERO }
}

impl NarrowPhaseInput<'_> {
    /// The side of a contact whose collider slides over the other collider as over ground.
    pub(super) fn sliding_side(&self, contact: &Contact) -> Option<usize> {
        let unit = self.bodies.length_unit();
        let square = |speed: f32| (speed * unit) * (speed * unit);
        let velocity = |side: usize| self.velocity(contact.bodies[side]).linear;
        let relative = (velocity(1) - velocity(0)).length_squared();
        // Most colliders do not move. Deep overlap is pushed out on all sides.
        if !(relative > square(min(SLIDING, MOVING))) || contact.flags.has(ContactFlags::DEEP) {
            return None;
        }
        match contact.bodies.map(|body| self.is_dynamic(body)) {
            [false, false] => None,
            [true, true] => (0..2).find(|side| {
                relative > square(SLIDING) && velocity(1 - side).length_squared() < square(RESTING)
            }),
            [is_of_a, _] => (relative > square(MOVING)).then_some(usize::from(!is_of_a)),
        }
    }

    /// Notes a sliding contact for comparison with the collider's other contacts, or the marked manifolds of
    /// a contact that no longer slides. `extra` are its recycled manifolds after the first; `has_more` tells
    /// whether it has several manifolds, recycled or new.
    #[inline(always)]
    pub(super) fn note_sliding(
        &self,
        id: u32,
        contact: &mut Contact,
        (extra, has_more): (&[Manifold], bool),
        worker: &mut WorkerBuffers,
    ) {
        let side = if contact.is_solved() { self.sliding_side(contact) } else { None };
        contact.flags.set(ContactFlags::SLIDES_A, side == Some(0));
        contact.flags.set(ContactFlags::SLIDES_B, side == Some(1));
        if let Some(side) = side {
            if has_more || contact.manifold.count > 0 {
                worker.sliding.push((contact.colliders[side], has_more || contact.manifold.is_internal));
            }
        } else {
            let marked =
                core::iter::once(&contact.manifold).chain(extra).zip(0..).filter(|(m, _)| m.is_internal);
            worker.internal.extend(marked.map(|(_, index)| (id, index)));
        }
    }

    /// Extent in a direction of the ground on the other side of a contact, from the centre of mass of this
    /// side's body; `None` for surfaces and planes.
    fn top(&self, contact: &Contact, side: usize, direction: Vector) -> Option<f32> {
        let mut fixed = [None; 2];
        let sides = self.sides(contact, &mut fixed);
        let (center, pose) = (sides.poses[side].center, sides.shape_poses()[1 - side]);
        let farthest = sides.shapes()[1 - side].support(pose.rotation.inverse_rotate(direction))?;
        Some(((pose.position - center).to_local() + pose.rotation.rotate(farthest)).dot(direction))
    }

    /// Whether the ground on the other side of a contact continues above the plane of manifold `holding`.
    fn rises(
        &self,
        contact: &Contact,
        side: usize,
        seen: &Seen,
        holding: &Seen,
        worker: &mut WorkerBuffers,
    ) -> bool {
        let up = holding.normal;
        let cos = seen.normal.dot(up);
        let (along, level) = (up - seen.normal * cos, seen.normal - up * cos);
        let steepness = along.length_squared();
        let highest = seen.points().map(|[p, _]| p).reduce(|a, b| if b.dot(up) > a.dot(up) { b } else { a });
        let Some(foot) = highest.filter(|_| steepness > 0.0) else { return false };
        let height = RISES * seen.flush;
        // Probes up along the ground, or straight up and slightly into it: a normal that points down may be
        // the collider's.
        let direction =
            if cos >= 0.0 { along * (1.0 / steepness) } else { up - level * (0.25 / level.length()) };
        let probe = foot + direction * (holding.plane() + height - foot.dot(up));
        let mut fixed = [None; 2];
        let sides = self.sides(contact, &mut fixed);
        let place = WorldPose::new(sides.poses[side].center + probe.to_world(), Rot::IDENTITY);
        let pose = sides.shape_poses()[1 - side].relative(&place);
        let ball = Ball { radius: 0.5 * height + sides.margin() };
        manifold_update::touches(sides.shapes()[1 - side], ball, &pose, worker)
    }
}

impl ContactTable {
    /// Marks the manifolds at internal edges of the noted colliders, so that they are not solved, and adds
    /// their loaded points to the lost points.
    pub(super) fn mark_internal(
        &mut self,
        input: &NarrowPhaseInput,
        pool: &ThreadPool,
        workers: &mut Vec<WorkerBuffers>,
    ) {
        let mut compared = core::mem::take(&mut self.compared);
        // A collider's only manifold cannot be internal, so it is not compared.
        for (collider, has_several) in workers.iter().flat_map(|worker| &worker.sliding) {
            let is_first = self.sliders.insert(*collider);
            if (*has_several || !is_first) && self.is_compared.insert(*collider) {
                compared.push(*collider);
            }
        }
        let this = &*self;
        pool.each_into(workers, compared.chunks(BLOCK), |worker, colliders| {
            colliders.iter().for_each(|collider| this.find_internal(input, *collider, worker));
        });
        compared.drain(..).for_each(|collider| _ = self.is_compared.remove(collider));
        self.compared = compared;
        for (collider, _) in workers.iter().flat_map(|worker| &worker.sliding) {
            self.sliders.remove(*collider);
        }
        let mut lost = core::mem::take(&mut self.lost);
        for (id, index) in workers.iter_mut().flat_map(|worker| worker.internal.drain(..)) {
            let contact = &self.contacts[id as usize];
            let side = usize::from(contact.flags.has(ContactFlags::SLIDES_B));
            let was = *self.manifold(contact, index).expect("the manifold was looked at");
            if !was.is_internal && input.match_points {
                impulse_transfer::note_internal((id, index), side, contact, &was, &mut lost);
            }
            let manifold = self.manifold_mut(id, index);
            manifold.is_internal = !was.is_internal;
            if manifold.is_internal {
                manifold.friction_impulse = Vector::ZERO;
                manifold.twist_impulse = NormalMoment::new(0.0);
                manifold.friction_owed = 0.0;
                manifold.points.iter_mut().for_each(|p| (p.impulse, p.total_impulse) = (0.0, 0.0));
            }
            let contact = &mut self.contacts[id as usize];
            // The collider passes an edge and then meets the face behind it, so this manifold is not
            // recycled. In a composite one contact has both.
            if !contact.flags.has(ContactFlags::COMPOSITE) {
                contact.flags.set(ContactFlags::FROZEN, false);
            }
            self.points[id as usize] = PointCount::of(contact);
        }
        self.lost = lost;
        for (id, index, normal) in workers.iter_mut().flat_map(|worker| worker.turned.drain(..)) {
            self.turn(id, index, normal);
        }
    }

    /// Lists the manifolds of a sliding collider whose mark changes, and the manifolds that get another
    /// normal.
    fn find_internal(&self, input: &NarrowPhaseInput, collider: u32, worker: &mut WorkerBuffers) {
        let mut all = core::mem::take(&mut worker.slides);
        all.clear();
        for (contact, index, side, m) in self.sliding_manifolds(input, collider).filter(|(.., m)| m.count > 0)
        {
            let is_round = m.radii != [0.0; 2];
            let line = match m.points() {
                [p, q] if is_round => unit(q.anchor - p.anchor),
                _ => Vector::ZERO,
            };
            all.push(Sliding {
                contact,
                index,
                order: all.len() as u32,
                side,
                normal: impulse_transfer::toward(side, m),
                is_round,
                is_face: m.count > 2,
                line,
                is_marked: m.is_internal,
                group: 0,
                height: 0.0,
            });
        }
        let mut groups = core::mem::take(&mut worker.parallel);
        self.group_parallel(input, &mut all, &mut groups);
        for this in &all {
            let role = match groups.len() {
                1 => Role::Obstacle,
                _ => self.role(input, this, &all, &groups, worker),
            };
            if (role == Role::Internal) != this.is_marked {
                worker.internal.push((this.contact, this.index));
            }
            if let Role::Turned(normal) = role {
                worker.turned.push((this.contact, this.index, normal));
            }
        }
        worker.slides = all;
        worker.parallel = groups;
    }

    /// Groups parallel manifolds. Several groups are each sorted by plane height.
    fn group_parallel(&self, input: &NarrowPhaseInput, all: &mut [Sliding], groups: &mut Vec<Parallel>) {
        groups.clear();
        // Normals within half of the tolerance of one normal are parallel to each other.
        let tolerance = 0.5 * if all.iter().any(|m| m.is_round) { ALIKE } else { PARALLEL };
        for m in &mut *all {
            let near = groups.iter_mut().zip(0..).find_map(|(group, number)| {
                let apart = (m.normal - group.normal).length_squared();
                (apart < tolerance * tolerance).then_some((group, number, apart))
            });
            if let Some((group, number, apart)) = near {
                group.spread = max(group.spread, apart.sqrt());
                m.group = number;
            } else {
                m.group = groups.len() as u32;
                groups.push(Parallel { normal: m.normal, spread: 0.0, range: 0..0 });
            }
        }
        if groups.len() == 1 {
            return;
        }
        all.iter_mut().for_each(|m| m.height = self.see(input, m).plane());
        let by_height = |a: &Sliding, b: &Sliding| b.height.total_cmp(&a.height).then(a.order.cmp(&b.order));
        all.sort_unstable_by(|a, b| a.group.cmp(&b.group).then_with(|| by_height(a, b)));
        let mut end = 0;
        for of_one in all.chunk_by(|a, b| a.group == b.group) {
            let start = end;
            end += of_one.len();
            groups[of_one[0].group as usize].range = start..end;
        }
    }

    fn see<'a>(&'a self, input: &NarrowPhaseInput, sliding: &Sliding) -> Seen<'a> {
        let contact = self.get(sliding.contact);
        let manifold = self.manifold(contact, sliding.index).expect("its contact has it");
        Seen::new(input, contact, sliding.side, manifold)
    }

    /// Classifies a manifold against the collider's other manifolds.
    fn role(
        &self,
        input: &NarrowPhaseInput,
        this: &Sliding,
        all: &[Sliding],
        groups: &[Parallel],
        worker: &mut WorkerBuffers,
    ) -> Role {
        let contact = self.get(this.contact);
        let seen = &self.see(input, this);
        let (mut is_held, mut plane, mut level) = (false, None, None);
        for (group, _) in groups.iter().zip(0..).filter(|(_, number)| *number != this.group) {
            // Planes below its points do not make it redundant.
            let least = seen.least_top(group);
            let others = all[group.range.clone()].iter().take_while(|other| !(other.height < least));
            for other in others.filter(|other| !this.is_parallel(other)) {
                let holding = self.see(input, other);
                // At a seam the ground of this manifold ends at the holding plane, but the holding ground
                // does not end at the plane of this manifold.
                let mut ends_at = |of: &Sliding, own: &Seen, plane: &Seen| {
                    let contact = self.get(of.contact);
                    let top = input.top(contact, of.side, plane.normal);
                    let mut rises = || input.rises(contact, of.side, own, plane, worker);
                    top.map_or_else(|| !rises(), |top| top - plane.plane() <= plane.flush)
                };
                let is_plane_of_both = || ends_at(this, seen, &holding) && !ends_at(other, &holding, seen);
                if !seen.is_held_by(&holding, is_plane_of_both) {
                    continue;
                }
                let ground = self.get(other.contact).colliders[1 - other.side];
                let stands = self.stands_on([contact.colliders[1 - this.side], ground], holding.normal);
                let cos = seen.normal.dot(holding.normal);
                if stands || input.rises(contact, this.side, seen, &holding, worker) {
                    let (steepest, first, _) = level.unwrap_or((-SIDEWAYS, 0, Vector::ZERO));
                    if cos < steepest || cos == steepest && other.order < first {
                        level = Some((cos, other.order, unit(seen.normal - holding.normal * cos)));
                    }
                    continue;
                }
                if cos < SAME_FACE || this.is_round || other.is_round {
                    return Role::Internal;
                }
                is_held = true;
                // `other` supports the plane only at its own points. Here the collider may come down by
                // turning.
                let is_plane = [this, other].into_iter().all(|of| {
                    let top = input.top(self.get(of.contact), of.side, holding.normal);
                    top.is_none_or(|top| top - holding.plane() <= holding.flush)
                });
                if is_plane && plane.is_none_or(|(first, _)| other.order < first) {
                    plane = Some((other.order, holding.normal));
                }
            }
        }
        match (level, plane) {
            (Some((.., normal)), _) | (None, Some((_, normal))) => Role::Turned(normal),
            (None, None) if is_held => Role::Internal,
            (None, None) => Role::Obstacle,
        }
    }

    /// Replaces a manifold's normal, from the ground to the collider. Its points on the ground stay.
    fn turn(&mut self, id: u32, index: u32, normal: Vector) {
        let side = if self.get(id).flags.has(ContactFlags::SLIDES_B) { 1.0 } else { -1.0 };
        let manifold = self.manifold_mut(id, index);
        let (old, new) = (manifold.normal, normal * side);
        let cos = old.dot(new);
        if !(cos > SIDEWAYS) {
            return;
        }
        for p in &mut manifold.points[..usize::from(manifold.count)] {
            p.anchor += (new * (p.frozen_separation / cos) - old * p.frozen_separation) * (0.5 * side);
            p.frozen_separation /= cos;
            p.separation /= cos;
        }
        manifold.normal = new;
    }

    /// Whether the first of two colliders stands on the second along this plane normal: then its foot is an
    /// obstacle.
    fn stands_on(&self, [standing, ground]: [u32; 2], normal: Vector) -> bool {
        standing != ground
            && self.find(standing, ground).is_some_and(|id| {
                let contact = self.get(id);
                contact.flags.has(ContactFlags::TOUCHING)
                    && !contact.flags.has(ContactFlags::SENSOR)
                    && contact.manifold.normal.dot(normal).abs() > SAME_FACE
            })
    }
}
