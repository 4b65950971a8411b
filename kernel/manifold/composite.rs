//! Contact manifolds of composite shapes: part by part, then merged: parts with the same normal share a
//! manifold. A closed convex surface collides as the solid that it bounds.

use super::dim::{Convex, face_normal, few_points, with_convex};
use super::parts::{ClosedSurface, PartBuffers, PartQuery};
use super::{FeatureCache, LocalManifold, LocalPoint, ManifoldQuery};
use crate::math::{Pose, max, min};
use crate::shape::{Aabb, Composite, Part, Shape};
use crate::tuning::manifold::{ALIKE, SAME, SAME_NORMAL};
use crate::tuning::sweeps::CORE_SHARE;
use core::cell::Cell;

/// Buffers for the manifolds of composite shapes, kept between calls.
#[derive(Clone, Debug, Default)]
pub struct CompositeBuffers {
    /// The cache of the pair, where a surface counts as one solid; see [`collide`](super::collide).
    pub cache: FeatureCache,
    parts: PartBuffers,
    merging: Merging,
}

impl CompositeBuffers {
    /// A lower bound of the distance to the parts that the motion of the last call leads past.
    pub fn passed(&self) -> f32 {
        self.parts.passed
    }
}

/// Adds the manifolds of a pair with at least one composite shape, in A's frame; see
/// [`collide`](super::collide). Returns a lower bound of the distance between the shapes: infinite if no part
/// is near, 0 if there are points.
pub fn collide_composite(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    query: ManifoldQuery<'_>,
    buffers: &mut CompositeBuffers,
    out: &mut Vec<LocalManifold>,
) -> f32 {
    let CompositeBuffers { cache, parts, merging } = buffers;
    let gap = collide_parts([a, b], pose_b_in_a, query, false, Cell::from_mut(cache), parts);
    let start = out.len();
    merge(&mut parts.found, merging, out);
    out[start..].iter_mut().for_each(|m| m.place_on_mover(query.ground));
    if parts.found.is_empty() { gap } else { 0.0 }
}

/// Adds the manifolds of all parts in A's frame, each part on its own: of parts within the prediction, and of
/// parts that the motion may meet. Each normal and separation is the slab between two convex shapes.
pub fn collide_each_part(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    query: ManifoldQuery<'_>,
    buffers: &mut CompositeBuffers,
    out: &mut Vec<LocalManifold>,
) {
    let cache = Cell::new(FeatureCache::NONE);
    collide_parts([a, b], pose_b_in_a, query, true, &cache, &mut buffers.parts);
    out.extend_from_slice(&buffers.parts.found);
}

/// Fills `buffers.found` with the manifolds of parts. Returns a lower bound of the distance to parts without
/// a manifold.
fn collide_parts(
    [a, b]: [&Shape; 2],
    pose_b_in_a: &Pose,
    query: ManifoldQuery<'_>,
    alone: bool,
    cache: &Cell<FeatureCache>,
    buffers: &mut PartBuffers,
) -> f32 {
    buffers.clear();
    let is_usable = pose_b_in_a.position.is_finite() && pose_b_in_a.rotation.is_finite();
    if !(is_usable && query.prediction.is_finite() && query.motion.is_finite()) {
        return 0.0;
    }
    let pose_a_in_b = pose_b_in_a.inverse();
    let of_a = forms([a, b], pose_b_in_a, query, 0, alone);
    let of_b = forms([b, a], &pose_a_in_b, query, 1, alone);
    // The composite comes first; of two composites, the larger.
    let is_b = match (of_a, of_b) {
        ((_, None), (_, None)) => !(a.ball_around().1 >= b.ball_around().1),
        ((parts, _), (_, whole)) => parts.is_none() || whole.is_none(),
    };
    let (first, second, pose, query) = match is_b {
        false => (of_a, of_b, pose_b_in_a, query),
        true => (of_b, of_a, &pose_a_in_b, query.swapped(pose_b_in_a)),
    };
    // Points are on B if both are composite.
    let on_composite = is_b && of_a.0.is_some();
    let gap = match (first, second) {
        ((Some(composite), whole), (_, Some(other))) => with_other(composite, other, |other| {
            let cache = whole.map(|_| cache);
            let part_query = PartQuery::new(composite, other, pose, query, alone);
            PartQuery { on_composite, is_b, cache, ..part_query }.collide(buffers)
        }),
        ((Some(large), _), (Some(small), _)) => {
            collide_both([large, small], pose, query, alone, on_composite, buffers)
        }
        _ => {
            debug_assert!(false, "one of the shapes is composite");
            0.0
        }
    };
    if is_b {
        buffers.found.iter_mut().for_each(|m| *m = m.flipped(&pose_a_in_b));
    }
    gap
}

/// The first shape as a composite and as a convex shape, where it is one. A closed convex surface is both: it
/// counts as the solid that it bounds, unless the other shape is inside or its facets have materials of their
/// own.
fn forms<'a>(
    [shape, other]: [&'a Shape; 2],
    pose: &Pose,
    query: ManifoldQuery<'_>,
    side: usize,
    alone: bool,
) -> (Option<&'a Composite<Shape>>, Option<&'a Shape>) {
    let Shape::Composite(composite) = shape else { return (None, Some(shape)) };
    let solid = composite.solid().filter(|_| !alone && query.groups[side].is_empty());
    let only_part = solid.and_then(|solid| solid.solids().first()).map(|(_, part)| part);
    let is_outside = |part: &Shape| {
        if query.ground[1 - side] && !query.ground[side] || !(other.ball_around().1 < shape.ball_around().1) {
            return true;
        }
        let Shape::Hull(hull) = part else { return false };
        let around = other.local_box(pose);
        let (center, half) = (around.center(), around.half());
        // A shape that does not move may be a room. A shape inside keeps its centre inside.
        let deep = if query.ground[side] { 0.0 } else { CORE_SHARE };
        !hull.contains(center, |normal| deep * normal.abs().dot(half))
    };
    match only_part.filter(|part| is_outside(part)) {
        None => (Some(composite), None),
        part => (solid, part),
    }
}

/// Calls `f` with a shape to collide with the parts of a composite.
fn with_other<R>(composite: &Composite<Shape>, other: &Shape, f: impl FnOnce(&Convex) -> R) -> R {
    match composite.surface() {
        Some(_) => with_convex(other, f),
        None => f(&Convex::of(other)),
    }
}

/// Collides two composites: each near part of the smaller against the whole larger composite. The smaller
/// cannot enclose the larger, so a closed smaller surface is solid to the larger.
fn collide_both(
    [large, small]: [&Composite<Shape>; 2],
    pose: &Pose,
    query: ManifoldQuery<'_>,
    alone: bool,
    on_composite: bool,
    buffers: &mut PartBuffers,
) -> f32 {
    let (bounds, inverse) = (large.tree().bounds(), pose.inverse());
    let around = bounds.rotated(inverse.rotation);
    let near = Aabb { min: around.min + inverse.position, max: around.max + inverse.position };
    let mut parts = Vec::new();
    small.tree().query(&near.grown(query.prediction + query.motion.length()), |part| parts.push(part));
    // Parts that are not near are beyond the search distance.
    let beyond =
        if parts.len() < small.len() { query.prediction + query.motion.length() } else { f32::INFINITY };
    let closed_surface = |part: u32| {
        let surface = small.surface().filter(|surface| surface.outward() != 0.0)?;
        let outward = pose.rotation.rotate(face_normal(surface.corners(part))?) * surface.outward();
        Some(ClosedSurface { surface, around: small.tree().bounds(), outward })
    };
    parts.iter().fold(beyond, |gap, part| {
        let collide_part = |other: &Shape, pose: &Pose, closed_surface, buffers: &mut PartBuffers| {
            let (name, other_group) = (part + 1, query.group(1, *part));
            with_other(large, other, |other| {
                let part_query = PartQuery::new(large, other, pose, query, alone);
                PartQuery { name, other_group, on_composite, closed_surface, ..part_query }.collide(buffers)
            })
        };
        let here = match small.part(*part) {
            Part::Facet(facet) => collide_part(&Shape::from(facet), pose, closed_surface(*part), buffers),
            Part::Solid(at, solid) => collide_part(solid, &pose.then(at), None, buffers),
        };
        min(gap, here)
    })
}

/// The maximum number of points that [`few_points`] takes. A manifold with more is reduced several times.
const MANY_POINTS: usize = 64;

/// Buffers for [`merge`], kept between calls.
#[derive(Clone, Debug, Default)]
struct Merging {
    /// For each manifold, the index of its merged manifold.
    groups: Vec<usize>,
    points: Vec<LocalPoint>,
}

/// Merges the manifolds in `found` with the same groups and about the same normal, the deepest first, and
/// adds the results to `out`.
fn merge(found: &mut [LocalManifold], room: &mut Merging, out: &mut Vec<LocalManifold>) {
    let Merging { groups, points } = room;
    if let [only] = found {
        out.push(*only);
        return;
    }
    found.sort_by(|a, b| a.lower_bound().total_cmp(&b.lower_bound()));
    groups.clear();
    let start = out.len();
    for m in found.iter() {
        let is_round_alike =
            |o: &LocalManifold| o.radii.iter().zip(m.radii).all(|(r, q)| (r - q).abs() <= SAME * max(*r, q));
        let is_flat = m.radii == [0.0; 2];
        let is_parallel = |o: &LocalManifold| match is_flat {
            true => o.radii == m.radii && o.normal.dot(m.normal) > SAME_NORMAL,
            false => (o.normal - m.normal).length_squared() < ALIKE * ALIKE && is_round_alike(o),
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
            if points.len() + m.points().len() > MANY_POINTS {
                drop_twins(points);
                // The outermost points so far stay: a slab on hundreds of tiles stands on its corners.
                if points.len() > MANY_POINTS * 3 / 4 {
                    few_points(points, merged);
                    points.clear();
                    points.extend_from_slice(merged.points());
                }
            }
            points.extend_from_slice(m.points());
        }
        drop_twins(points);
        few_points(points, merged);
    }
}

/// Merges points at the same place: the deeper point stays.
fn drop_twins(points: &mut Vec<LocalPoint>) {
    let first = points[0].point;
    let spread = points.iter().fold(0.0, |far, p| max(far, (p.point - first).length_squared()));
    let mut kept = 0;
    for i in 0..points.len() {
        let point = points[i];
        let is_near = |p: &LocalPoint| (p.point - point.point).length_squared() <= SAME * SAME * spread;
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
