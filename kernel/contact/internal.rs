//! Internal edges: edges and sides of pieces that together are one surface.
//!
//! A body that slides over flush tiles, or over the triangles of a mesh, meets the sides and edges of the pieces ahead. Each
//! piece alone is an obstacle; together they are a plane. So the manifolds of a collider are compared: one whose points on
//! the ground all lie on the plane of another manifold, or below it, stops nothing that the other does not hold already, and
//! is not solved. Points on a kerb, a wall or the other side of a groove lie above that plane. A body that has only its foot at
//! a wall has no such point: there the wall itself is looked at, whether it goes on above the plane.
//!
//! Only manifolds of moving colliders with ground are compared: what is not dynamic, or is dynamic and at rest. The result
//! depends on positions alone, not on the order of manifolds.

use super::buffers::WorkerBuffers;
use super::input::{ManifoldSource, NarrowPhaseInput, smaller};
use super::load;
use super::manifolds;
use super::record::{Contact, ContactFlags, Manifold};
use super::table::{ContactTable, PointCount};
use crate::math::{Rot, Vector, WorldPose, max, min};
use crate::shape::{Ball, Shape};
use crate::table::{BodyKind, NONE};
use crate::thread_pool::ThreadPool;

/// How far above a plane a point may lie that counts as on it, in metres. More would hide kerbs; less is below the rounding of
/// positions some kilometres from the origin.
const FLUSH: f32 = 2.5e-4;

/// Faces are clipped beyond their edges by this share of the smaller shape's extent, and so are points on them.
const CLIPPED: f32 = 1.0e-3;

/// How far below a plane the collider may reach, besides how deep the plane's own contact is, in metres. What reaches farther
/// down is another part of a concave collider, which a pit may hold.
const BELOW: f32 = 0.005;

/// A wall is looked for at this height over a plane, in units of the height up to which points count as on it. More misses low
/// walls; less takes the edges of flush tiles for walls.
const RISES: f32 = 4.0;

/// Planes whose normals differ by less than this hold the same, squared, in radians: 0.2°.
const PARALLEL: f32 = 1.2e-5;

/// The same if both are of round shapes, whose point moves with the normal.
const ROUND_PARALLEL: f32 = 1.0e-8;

/// Bodies slower than this against ground that does not move slide over nothing, in m/s.
const MOVING: f32 = 0.02;

/// Dynamic bodies slower than this are ground, in m/s ...
const RESTING: f32 = 0.05;

/// ... for those that move faster than this against them, in m/s.
const SLIDING: f32 = 0.25;

/// How many contacts a worker takes at a time.
const BLOCK: usize = 64;

/// A manifold, seen by the collider on one side of it.
struct Seen<'a> {
    manifold: &'a Manifold,
    /// From the ground to the collider.
    normal: Vector,
    /// From the collider's body to the origin of the anchors.
    origin: Vector,
    /// How far above a plane its points may lie.
    flush: f32,
}

impl<'a> Seen<'a> {
    fn new<S>(input: &NarrowPhaseInput<S>, contact: &Contact, side: usize, manifold: &'a Manifold) -> Self {
        let mut fixed = [None; 2];
        let poses = input.poses(contact, &mut fixed);
        let ground = 1 - side;
        // Points of a recycled manifold keep their places on the ground.
        let frozen = if ground == 1 { contact.frozen.offset } else { Vector::ZERO };
        let origin = (poses[ground].center - poses[side].center).to_local() - frozen;
        let normal = if side == 0 { -manifold.normal } else { manifold.normal };
        let [a, b] = input.reaches(contact);
        let is_curved = |id: u32| matches!(input.colliders[id].def.shape, Shape::Curved(_));
        let is_clipped = manifold.radii == [0.0; 2] || contact.colliders.into_iter().any(is_curved);
        let clipped = if is_clipped { CLIPPED * smaller([a.extent, b.extent]) } else { 0.0 };
        Self { manifold, normal, origin, flush: FLUSH + clipped }
    }

    /// The points on the ground, and those across on the collider.
    fn points(&self) -> impl Iterator<Item = [Vector; 2]> + '_ {
        self.manifold.points().iter().map(|p| {
            let (middle, half) = (self.origin + p.anchor, self.normal * (0.5 * p.frozen_separation));
            [middle - half, middle + half]
        })
    }

    /// The plane's height along its normal.
    fn plane(&self) -> f32 {
        self.points().fold(f32::NEG_INFINITY, |top, [p, _]| max(top, p.dot(self.normal)))
    }

    /// The height of the highest point on the ground of another manifold over this plane.
    fn highest(&self, other: &Seen) -> f32 {
        other.points().fold(f32::NEG_INFINITY, |top, [p, _]| max(top, p.dot(self.normal))) - self.plane()
    }

    /// Whether another manifold, which is not parallel, holds what this one would stop.
    fn is_held_by(&self, other: &Seen) -> bool {
        let highest = other.highest(self);
        if !(highest <= self.flush && highest < self.highest(other)) {
            return false;
        }
        let lowest = self.points().fold(f32::INFINITY, |low, [_, own]| min(low, own.dot(other.normal)));
        let deepest = other.manifold.points().iter().fold(0.0, |deep, p| min(deep, p.separation));
        lowest - other.plane() >= deepest - BELOW
    }
}

/// Whether two manifolds, seen from the same collider, hold the same. `is_flipped` tells that one is of side A, the other of B.
fn are_parallel(a: &Manifold, b: &Manifold, is_flipped: bool) -> bool {
    let are_round = a.radii != [0.0; 2] && b.radii != [0.0; 2];
    let parallel = if are_round { ROUND_PARALLEL } else { PARALLEL };
    let apart = if is_flipped { a.normal + b.normal } else { a.normal - b.normal };
    apart.length_squared() < parallel
}

impl<S> NarrowPhaseInput<'_, S> {
    fn speed_squared(&self, body: u32) -> f32 {
        if body == NONE { 0.0 } else { self.bodies.velocities[body as usize].linear.length_squared() }
    }

    fn is_dynamic(&self, body: u32) -> bool {
        body != NONE && self.bodies[body].kind == BodyKind::Dynamic
    }

    /// Whether the collider on a side of a contact slides over the other one as over ground.
    pub(super) fn slides(&self, contact: &Contact, side: usize) -> bool {
        let [body, ground] = [contact.bodies[side], contact.bodies[1 - side]];
        // Deep overlap is pushed out from all sides.
        if !self.is_dynamic(body) || contact.flags.has(ContactFlags::DEEP) {
            return false;
        }
        let relative = self.relative_speed_squared(contact);
        if self.is_dynamic(ground) {
            relative > SLIDING * SLIDING && self.speed_squared(ground) < RESTING * RESTING
        } else {
            relative > MOVING * MOVING
        }
    }

    /// Whether a contact's manifolds are to be compared with others of the same collider.
    #[inline(always)]
    pub(super) fn may_be_internal(&self, contact: &Contact) -> bool {
        contact.is_solved()
            && (contact.manifold.is_internal
                || contact.extra_count > 0
                || self.moves(contact) && (self.slides(contact, 0) || self.slides(contact, 1)))
    }

    /// Whether the ground on the other side of a contact goes on above the plane of a holding manifold.
    fn rises<W>(
        &self,
        contact: &Contact,
        side: usize,
        seen: &Seen,
        holding: &Seen,
        worker: &mut WorkerBuffers<W>,
    ) -> bool {
        let up = holding.normal;
        let cos = seen.normal.dot(up);
        let (along, level) = (up - seen.normal * cos, seen.normal - up * cos);
        let steepness = along.length_squared();
        let highest = seen.points().map(|[p, _]| p).reduce(|a, b| if b.dot(up) > a.dot(up) { b } else { a });
        let Some(foot) = highest.filter(|_| steepness > 0.0) else { return false };
        let height = RISES * seen.flush;
        // Up along the ground, or straight up and a little into it: a normal that points down may be the collider's.
        let direction =
            if cos >= 0.0 { along * (1.0 / steepness) } else { up - level * (0.25 / level.length()) };
        let probe = foot + direction * (holding.plane() + height - foot.dot(up));
        let mut fixed = [None; 2];
        let center = self.poses(contact, &mut fixed)[side].center;
        let ground = contact.colliders[1 - side] as usize;
        let shape = &self.colliders[ground as u32].def.shape;
        let pose =
            self.colliders.poses[ground].relative(&WorldPose::new(center + probe.to_world(), Rot::IDENTITY));
        let ball = Ball { radius: 0.5 * height + self.margin(contact) };
        manifolds::touches(shape, ball, &pose, worker)
    }

    /// Whether a contact's bodies move against each other fast enough to [slide](Self::slides). Most do not.
    #[inline(always)]
    fn moves(&self, contact: &Contact) -> bool {
        self.relative_speed_squared(contact) > min(SLIDING, MOVING) * min(SLIDING, MOVING)
    }

    #[inline(always)]
    fn relative_speed_squared(&self, contact: &Contact) -> f32 {
        (self.velocity(contact, 1).linear - self.velocity(contact, 0).linear).length_squared()
    }
}

impl ContactTable {
    /// Marks the manifolds of internal edges among the contacts that the workers noted, so that they are not solved. Adds their
    /// points to those that were lost.
    pub(super) fn mark_internal<S: ManifoldSource>(
        &mut self,
        input: &NarrowPhaseInput<S>,
        pool: &ThreadPool,
        workers: &mut Vec<WorkerBuffers<S::Workspace>>,
    ) {
        let mut sliding = core::mem::take(&mut self.sliding);
        workers.iter().for_each(|worker| sliding.extend_from_slice(&worker.sliding));
        let this = &*self;
        pool.each_into(workers, sliding.chunks(BLOCK), |worker, ids| {
            ids.iter().for_each(|id| this.find_internal(input, *id, worker));
        });
        sliding.clear();
        self.sliding = sliding;
        let mut lost = core::mem::take(&mut self.lost);
        for (id, index) in workers.iter_mut().flat_map(|worker| worker.internal.drain(..)) {
            let contact = &self.contacts[id as usize];
            let side = usize::from(!input.slides(contact, 0));
            let was = *self.manifold(contact, index).expect("the manifold was looked at");
            if !was.is_internal && input.match_points {
                load::note_internal((id, index), side, contact, &was, &mut lost);
            }
            let contact = &mut self.contacts[id as usize];
            let manifold = match index {
                0 => &mut contact.manifold,
                _ => &mut self.extra[contact.extra as usize][index as usize - 1],
            };
            manifold.is_internal = !was.is_internal;
            if manifold.is_internal {
                manifold.friction_impulse = Vector::ZERO;
                manifold.twist_impulse = 0.0;
                manifold.points.iter_mut().for_each(|p| (p.impulse, p.total_impulse) = (0.0, 0.0));
            }
            self.points[id as usize] = PointCount::of(contact);
        }
        self.lost = lost;
    }

    /// Adds the manifolds of a contact whose mark is to change.
    fn find_internal<S, W>(&self, input: &NarrowPhaseInput<S>, id: u32, worker: &mut WorkerBuffers<W>) {
        let contact = self.get(id);
        for index in 0..=u32::from(contact.extra_count) {
            let Some(manifold) = self.manifold(contact, index).filter(|m| m.count > 0) else { continue };
            let is_internal = (0..2).any(|side| {
                input.slides(contact, side) && self.is_internal(input, id, side, manifold, worker)
            });
            if is_internal != manifold.is_internal {
                worker.internal.push((id, index));
            }
        }
    }

    /// Whether another manifold of the collider on a side of a contact holds what this one would stop.
    fn is_internal<S, W>(
        &self,
        input: &NarrowPhaseInput<S>,
        id: u32,
        side: usize,
        manifold: &Manifold,
        worker: &mut WorkerBuffers<W>,
    ) -> bool {
        let contact = self.get(id);
        let (collider, ground) = (contact.colliders[side], contact.colliders[1 - side]);
        let mut seen = None;
        self.of_collider(collider, input.colliders).any(|other_id| {
            let other = self.get(other_id);
            let other_side = usize::from(other.colliders[1] == collider);
            (0..=u32::from(other.extra_count)).any(|other_index| {
                let Some(m) = self.manifold(other, other_index).filter(|m| m.count > 0) else { return false };
                // Most are of the same plane, or this one itself. All else is looked at only if not.
                if are_parallel(manifold, m, side != other_side)
                    || !other.is_solved()
                    || !(other_id == id || input.slides(other, other_side))
                {
                    return false;
                }
                let seen = seen.get_or_insert_with(|| Seen::new(input, contact, side, manifold));
                let holding = Seen::new(input, other, other_side, m);
                seen.is_held_by(&holding)
                    && !self.stands_on([ground, other.colliders[1 - other_side]], holding.normal)
                    && !input.rises(contact, side, seen, &holding, worker)
            })
        })
    }

    /// Whether the first of two colliders stands on the second, whose plane has this normal: then its foot is an obstacle.
    fn stands_on(&self, [standing, ground]: [u32; 2], normal: Vector) -> bool {
        standing != ground
            && self.find(standing, ground).is_some_and(|id| {
                let contact = self.get(id);
                contact.flags.has(ContactFlags::TOUCHING)
                    && !contact.flags.has(ContactFlags::SENSOR)
                    && contact.manifold.normal.dot(normal).abs() > 0.9
            })
    }
}
