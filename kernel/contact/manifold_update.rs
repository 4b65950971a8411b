//! Computes the manifolds of one contact in A's frame, replaces its old manifolds in world axes, and holds
//! the buffers and results of the worker that does so.

use super::input::Sides;
use super::record::{Contact, ContactFlags, LostImpulse, Manifold, ManifoldPoint, Parallel, Sliding};
use super::recycle::RecycleBatch;
use super::time_of_impact::Meeting;
use crate::manifold::{self, CompositeBuffers, FeatureCache, LocalManifold, ManifoldQuery};
use crate::math::{Pose, Rot, Vector, min};
use crate::shape::{Ball, Shape};
use crate::tuning::contact::SAME_FACE;

/// Buffers of one worker, kept between steps. Every contact writes them, so each worker has its own cache
/// lines.
#[derive(Clone, Debug, Default)]
#[repr(align(128))]
pub struct WorkerBuffers {
    /// Manifolds of the current contact, in A's frame.
    pub(super) local: Vec<LocalManifold>,
    pub(super) composite: CompositeBuffers,
    /// Contacts that may be recycled.
    pub(super) batch: RecycleBatch,
    /// Manifolds after the first of the last updated contact.
    pub extra: Vec<Manifold>,
    /// Contacts that began or ended to touch, or whose boxes came apart.
    pub(super) changed: Vec<u32>,
    /// Contacts whose manifolds after the first are to be stored, with their count.
    pub(super) stored: Vec<(u32, usize)>,
    /// The manifolds of `stored`, in the same order.
    pub(super) pool: Vec<Manifold>,
    /// Sliding colliders, one entry per contact with points, and whether this contact alone requires a
    /// comparison.
    pub(super) sliding: Vec<(u32, bool)>,
    /// Manifolds of the current sliding collider.
    pub(super) slides: Vec<Sliding>,
    /// Groups of parallel manifolds in `slides`.
    pub(super) parallel: Vec<Parallel>,
    /// (contact, manifold) pairs whose [`is_internal`](Manifold::is_internal) changes.
    pub(super) internal: Vec<(u32, u32)>,
    /// (contact, manifold) pairs with their new normals, from the ground to the collider.
    pub(super) turned: Vec<(u32, u32, Vector)>,
    /// Loaded points that sliding colliders lost.
    pub(super) lost: Vec<LostImpulse>,
    /// Whether any contact overlaps deeply.
    pub(super) any_deep: bool,
}

impl WorkerBuffers {
    /// Clears the results of the last update.
    pub(super) fn clear(&mut self) {
        self.changed.clear();
        self.stored.clear();
        self.pool.clear();
        self.sliding.clear();
        self.internal.clear();
        self.turned.clear();
        self.lost.clear();
        self.any_deep = false;
    }
}

/// Computes the manifold of two native shapes at their present poses, with points up to `prediction` apart,
/// margins not subtracted. Rim points are placed at the middle of the step; returns how far the surfaces may
/// move before these points lag behind.
#[inline(always)]
pub(super) fn collide(
    sides: &Sides,
    contact: &mut Contact,
    prediction: f32,
    local: &mut LocalManifold,
) -> f32 {
    let (shapes, relative) = (sides.shapes(), sides.relative());
    manifold::collide(shapes[0], shapes[1], &relative, prediction, &mut contact.cache, local);
    let is_curved = |shape: &Shape| matches!(shape, Shape::Curved(_));
    if local.count == 0 || !(is_curved(shapes[0]) || is_curved(shapes[1])) {
        return f32::INFINITY;
    }
    let spin = sides.velocity(1).angular - sides.velocity(0).angular;
    // Only touching points are moved: a separated point moved past a seam of the ground would not be
    // recognised as a point of an inner edge.
    let (near, turn) = (sides.margin(), spin * (0.5 * sides.input.dt));
    manifold::midstep_rims(shapes, sides.frame(), &relative, turn, near, local)
}

/// Whether a ball overlaps a shape, given the ball's pose in the shape's frame. Always false for foreign
/// shapes.
pub(super) fn touches(shape: &Shape, ball: Ball, pose: &Pose, buffers: &mut WorkerBuffers) -> bool {
    let WorkerBuffers { composite, local, .. } = buffers;
    let (ball, mut found) = (Shape::Ball(ball), LocalManifold::default());
    match shape {
        Shape::Foreign(_) => return false,
        Shape::Composite(_) => {
            let query = ManifoldQuery::up_to(0.0);
            local.clear();
            manifold::collide_composite(shape, &ball, pose, query, composite, local);
            return !local.is_empty();
        }
        _ => manifold::collide(shape, &ball, pose, 0.0, &mut FeatureCache::NONE.clone(), &mut found),
    }
    found.count > 0
}

/// Adds the manifolds of a pair with a composite shape, margins not subtracted. The motion is B's relative to
/// A in this step, in world axes; parts farther away than `met` may be passed by. Returns a lower bound of
/// the distance between the shapes.
pub(super) fn collide_parts(
    sides: &Sides,
    contact: &mut Contact,
    prediction: f32,
    (motion, met): (Vector, f32),
    buffers: &mut WorkerBuffers,
) -> f32 {
    let (shapes, relative) = (sides.shapes(), sides.relative());
    let groups = sides.colliders.map(|id| {
        let facets = sides.input.colliders[id].def.facets.as_ref();
        facets.map_or(&[][..], |facets| facets.groups())
    });
    let ground = sides.are_dynamic().map(|is_dynamic| !is_dynamic);
    let query =
        ManifoldQuery { prediction, motion: sides.frame().inverse_rotate(motion), met, ground, groups };
    let WorkerBuffers { composite, local, .. } = buffers;
    composite.cache = contact.cache;
    let gap = manifold::collide_composite(shapes[0], shapes[1], &relative, query, composite, local);
    contact.cache = composite.cache;
    gap
}

/// Removes the separated points of a sensor's contact that do not close in this step. Returns the smallest
/// separation of the removed points, or infinity.
pub(super) fn keep_met(sides: &Sides, found: &mut Vec<LocalManifold>) -> f32 {
    let motion = sides.frame().inverse_rotate(sides.predicted_motion());
    let margin = sides.margin();
    let mut gap = f32::INFINITY;
    for local in found.iter_mut() {
        let parting = local.normal.dot(motion);
        let all = core::mem::take(&mut local.count);
        for i in 0..all {
            let separation = local.points[i].separation - margin;
            if separation <= 0.0 || separation + parting <= 0.0 {
                local.points[local.count] = local.points[i];
                local.count += 1;
            } else {
                gap = min(gap, separation);
            }
        }
    }
    found.retain(|local| local.count > 0);
    gap
}

/// Replaces the contact's manifolds by `buffers.local`. Points inherit the impulses of matching old points.
/// Manifolds after the first go to `buffers.extra`; `old_extra` are the old manifolds after the first.
pub(super) fn replace(
    sides: &Sides,
    contact: &mut Contact,
    old_extra: &[Manifold],
    meeting: Option<&Meeting>,
    buffers: &mut WorkerBuffers,
) {
    buffers.extra.clear();
    if contact.manifold.count == 0 && buffers.local.is_empty() {
        contact.flags.set(ContactFlags::TOUCHING, false);
        return;
    }
    let margin = sides.margin();
    let pose_a = meeting.map_or(sides.shape_poses()[0], |meeting| &meeting.placed[0].shape);
    let body_a = meeting.map_or(sides.poses[0], |meeting| &meeting.placed[0].body);
    // From body A's centre of mass to collider A's origin, in world axes.
    let to_shape = (pose_a.position - body_a.center).to_local();
    let old = core::mem::take(&mut contact.manifold);
    let is_foreign = contact.flags.has(ContactFlags::FOREIGN);
    for (i, local) in buffers.local.iter().enumerate() {
        let mut m = to_world(local, pose_a.rotation, to_shape, margin);
        m.radii = if is_foreign { sides.shapes().map(Shape::radius) } else { local.radii };
        if let Some(meeting) = meeting {
            meeting.rewind(&mut m);
        }
        if !m.normal.is_finite()
            || m.points().iter().any(|p| !p.separation.is_finite() || !p.anchor.is_finite())
        {
            continue;
        }
        vary_first(&mut m, sides.colliders.map(|id| sides.input.colliders.number(id)));
        if sides.input.match_points {
            inherit(&mut m, core::iter::once(&old).chain(old_extra.iter()));
        }
        if i == 0 {
            contact.manifold = m;
        } else {
            buffers.extra.push(m);
        }
    }
    let touching = contact.manifold.count > 0 || !buffers.extra.is_empty();
    contact.flags.set(ContactFlags::TOUCHING, touching);
}

/// A manifold in world axes, with anchors from body A's centre of mass.
fn to_world(local: &LocalManifold, rotation: Rot, to_shape: Vector, margin: f32) -> Manifold {
    let mut m = Manifold {
        normal: rotation.rotate(local.normal),
        count: local.count as u8,
        groups: local.groups,
        ..Manifold::default()
    };
    for (out, p) in m.points.iter_mut().zip(local.points()) {
        let separation = p.separation - margin;
        *out = ManifoldPoint {
            anchor: to_shape + rotation.rotate(p.point),
            frozen_separation: separation - p.closing,
            separation,
            impulse: 0.0,
            total_impulse: 0.0,
            feature: p.feature,
        };
    }
    m
}

/// Varies the first point from contact to contact. Consecutive pairs of points stay together.
///
/// The solver takes points in sequence, which slightly favours some of them. If the favoured points were on
/// the same side in every contact, a stack would lean to that side as it settles. So the numbers of the
/// colliders choose the first point, by the R₂ sequence (M. Roberts, "The unreasonable effectiveness of
/// quasirandom sequences", 2018): it spreads evenly whether one or both of the numbers count up. Bits of the
/// sum of the numbers would follow the rows of a wall.
fn vary_first(m: &mut Manifold, [a, b]: [u32; 2]) {
    // 2³² / ρ and 2³² / ρ², where ρ³ = ρ + 1.
    const R2: [u32; 2] = [0xC13F_A9A9, 0x91E1_0DA6];
    if !m.count.is_power_of_two() {
        return;
    }
    let spread = a.wrapping_mul(R2[0]).wrapping_add(b.wrapping_mul(R2[1])) >> 30;
    let flip = (spread & (u32::from(m.count) - 1)) as usize;
    let old = m.points;
    for i in 0..usize::from(m.count) {
        m.points[i] = old[i ^ flip];
    }
}

/// Copies the impulses of the old manifold with the same facet groups and the nearest normal. Points are
/// matched by feature id.
fn inherit<'a>(m: &mut Manifold, old: impl Iterator<Item = &'a Manifold>) {
    let mut best: Option<(&Manifold, f32)> = None;
    for o in old.filter(|o| o.count > 0 && o.groups == m.groups) {
        let cos = o.normal.dot(m.normal);
        if cos > SAME_FACE && best.is_none_or(|(_, c)| cos > c) {
            best = Some((o, cos));
        }
    }
    let Some((old, _)) = best else { return };
    let mut any = false;
    for p in &mut m.points[..usize::from(m.count)] {
        if let Some(o) = old.points().iter().find(|o| o.feature == p.feature) {
            p.impulse = o.impulse;
            p.total_impulse = o.total_impulse;
            any = true;
        }
    }
    if any {
        m.friction_impulse = old.friction_impulse;
        m.twist_impulse = old.twist_impulse;
        m.friction_owed = old.friction_owed;
    }
}
