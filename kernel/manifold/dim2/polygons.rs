//! Two convex polygons, at least one with an area, by the edge normal that separates them most. Two cuboids,
//! the most frequent pair, have a search of their own.
//!
//! Where the separation along a direction is positive, it grows towards the best direction and falls behind
//! it. So the best edge of separated polygons is beside the nearest corner, and this edge and the edge facing
//! it have the closest features.

use super::super::{FeatureCache, LocalManifold, PairInput};
use super::polygonal::{Edge, Facing, Limits, NORMALS, Polygonal, Side, corners};
use crate::math::{Pose, Vector, min};
use crate::shape::Cuboid;

/// An edge with the vertex of the other polygon that is lowest over it.
#[derive(Clone, Copy)]
struct Best {
    edge: usize,
    support: usize,
    separation: f32,
}

/// Another edge must be better than the reference by this to replace it, in metres: a thousandth of the
/// prediction distance plus the rounding at the distance of the shapes' origins. It is far below the overlap
/// of resting contacts and far above the noise of equal boxes on each other.
#[inline]
fn preference(prediction: f32, pose: &Pose) -> f32 {
    1.0e-3 * prediction + 1.0e-6 * pose.position.abs().max_element()
}

/// Fills `out` for two polygons.
pub(super) fn collide(a: &Polygonal, b: &Polygonal, input: PairInput, out: &mut LocalManifold) {
    let PairInput { pose, prediction, cache } = input;
    let reach = prediction + a.radius + b.radius;
    let inverse = pose.inverse();
    let known = cached(a, b, pose, &inverse, cache.get());
    if let Some((_, best)) = known.filter(|(_, best)| best.separation > reach) {
        cache.set(FeatureCache { separation: best.separation, ..cache.get() });
        out.gap = best.separation - a.radius - b.radius;
        return;
    }
    let on_a = most_separating(a, b, &inverse, reach);
    let (side, best) = if on_a.separation > reach {
        (Side::A, on_a)
    } else {
        choose(on_a, most_separating(b, a, pose, reach), known, preference(prediction, pose))
    };
    cache.set(cache_of(side, best));
    if best.separation > reach {
        out.gap = best.separation - a.radius - b.radius;
        return;
    }

    let (own, other) = if side == Side::A { (a, b) } else { (b, a) };
    let reference = (own.edge(best.edge), own.normals[best.edge]);
    let facing = |normal| other.edge(other.edge_facing(normal, best.support));
    let limits = Limits { radii: [own.radius, other.radius], prediction };
    Facing::new(side, reference, facing, pose, limits).contact(best.separation > 0.0, out);
}

/// The reference edge: the better of two edges. While the polygons overlap or touch, it is the reference of
/// the last step, or otherwise A's edge, unless another edge is better by `preference`.
#[inline]
fn choose(on_a: Best, on_b: Best, known: Option<(Side, Best)>, preference: f32) -> (Side, Best) {
    let best = if on_b.separation > on_a.separation { (Side::B, on_b) } else { (Side::A, on_a) };
    if best.1.separation > preference {
        return best;
    }
    let floor = best.1.separation - preference;
    match known {
        Some(known) if known.1.separation >= floor => known,
        _ if on_a.separation >= floor => (Side::A, on_a),
        _ => best,
    }
}

/// Up to this number of vertices, testing all of them for every edge is faster than walking: it
/// has no branches.
const FEW: usize = 16;

/// [`FeatureCache::kind`] while the reference edge is A's.
const EDGE_OF_A: u8 = 1;

/// [`FeatureCache::kind`] while the reference edge is B's.
const EDGE_OF_B: u8 = 2;

/// The edge of `own` with the largest separation of `other`, given the pose of `own` in `other`'s frame. The
/// first edge above `reach` ends the search.
///
/// For a polygon with many vertices, not all vertices are tested for every edge: the lowest vertex moves
/// around the polygon in the same direction as the normals (rotating calipers; M. Shamos, 1978).
fn most_separating(own: &Polygonal, other: &Polygonal, pose: &Pose, reach: f32) -> Best {
    let mut best = (f32::NEG_INFINITY, 0, Vector::ZERO);
    let few = other.len() <= FEW;
    let mut support = if few { 0 } else { other.lowest(pose.rotation.rotate(own.normals[0])).0 };
    for (i, (v, n)) in own.vertices.iter().zip(own.normals).enumerate() {
        let normal = pose.rotation.rotate(*n);
        let height = if few {
            other.vertices.iter().fold(f32::INFINITY, |low, w| min(w.dot(normal), low))
        } else {
            support = descend(other, normal, support);
            other.vertices[support].dot(normal)
        };
        let separation = height - v.dot(*n) - pose.position.dot(normal);
        if separation > best.0 {
            best = (separation, i, normal);
            if separation > reach {
                break;
            }
        }
    }
    Best { edge: best.1, support: other.lowest(best.2).0, separation: best.0 }
}

/// The vertex least far along `normal`. The walk starts at the lowest vertex of a normal up to half a turn
/// behind. After nearly half a turn it may start on an edge that is level within rounding, so it tests two
/// vertices ahead.
#[inline]
fn descend(polygon: &Polygonal, normal: Vector, start: usize) -> usize {
    let (mut support, mut height) = (start, polygon.vertices[start].dot(normal));
    for _ in 0..polygon.len() {
        let next = polygon.next(support);
        let after = polygon.next(next);
        let heights = [next, after].map(|i| polygon.vertices[i].dot(normal));
        if heights[0] < height {
            (support, height) = (next, heights[0]);
        } else if heights[1] < height {
            (support, height) = (after, heights[1]);
        } else {
            break;
        }
    }
    support
}

/// The cached reference with its present separation.
fn cached(
    a: &Polygonal,
    b: &Polygonal,
    pose: &Pose,
    inverse: &Pose,
    cache: FeatureCache,
) -> Option<(Side, Best)> {
    let (side, edge) = known_edge(cache)?;
    let (own, other, pose) = if side == Side::A { (a, b, inverse) } else { (b, a, pose) };
    let normal = pose.rotation.rotate(*own.normals.get(edge)?);
    let (support, height) = other.lowest(normal);
    let separation = height - own.vertices[edge].dot(own.normals[edge]) - pose.position.dot(normal);
    Some((side, Best { edge, support, separation }))
}

/// The side and edge in a cache.
#[inline]
fn known_edge(cache: FeatureCache) -> Option<(Side, usize)> {
    match cache.kind {
        EDGE_OF_A => Some((Side::A, usize::from(cache.a))),
        EDGE_OF_B => Some((Side::B, usize::from(cache.b))),
        _ => None,
    }
}

/// The cache of a reference edge; empty if its index does not fit.
#[inline]
fn cache_of(side: Side, Best { edge, separation, .. }: Best) -> FeatureCache {
    match (side, u8::try_from(edge)) {
        (Side::A, Ok(a)) => FeatureCache { kind: EDGE_OF_A, a, b: 0, separation },
        (Side::B, Ok(b)) => FeatureCache { kind: EDGE_OF_B, a: 0, b, separation },
        (_, Err(_)) => FeatureCache::NONE,
    }
}

/// Fills `out` for two cuboids. The signs of the offset give the edges to test: four separations are
/// computed, where polygons need sixteen vertices. Edges and vertices are numbered as for polygons.
pub(in crate::manifold) fn collide_cuboids(
    a: &Cuboid,
    b: &Cuboid,
    input: PairInput,
    out: &mut LocalManifold,
) {
    let PairInput { pose, prediction, cache } = input;
    // In A's frame B's axes are the columns of R, in B's frame A's axes are its rows; |R| is symmetric
    // but for signs: |R h| = (|c| hx + |s| hy, |s| hx + |c| hy) either way.
    let (c, s) = (pose.rotation.cos.abs(), pose.rotation.sin.abs());
    let reach = |h: Vector| Vector { x: c * h.x + s * h.y, y: s * h.x + c * h.y };
    let (in_a, in_b) = (pose.position, pose.rotation.inverse_rotate(-pose.position));
    let (over_a, over_b) = (in_a.abs() - a.half - reach(b.half), in_b.abs() - b.half - reach(a.half));

    let (on_a, on_b) = (best_edge(in_a, over_a), best_edge(in_b, over_b));
    let known = known_edge(cache.get()).and_then(|(side, edge)| {
        let (offset, half, other) = if side == Side::A { (in_a, a, b) } else { (in_b, b, a) };
        let normal = NORMALS.get(edge)?;
        let extent = half.half + reach(other.half);
        let separation = offset.dot(*normal) - extent.dot(normal.abs());
        Some((side, Best { edge, support: 0, separation }))
    });
    let (side, best) = choose(on_a, on_b, known, preference(prediction, pose));
    cache.set(cache_of(side, best));
    if best.separation > prediction {
        out.gap = best.separation;
        return;
    }

    let (own, other) = if side == Side::A { (a, b) } else { (b, a) };
    let reference = (edge(own, best.edge), NORMALS[best.edge]);
    let limits = Limits { radii: [0.0; 2], prediction };
    Facing::new(side, reference, |normal| facing_edge(other, normal), pose, limits)
        .contact(best.separation > 0.0, out);
}

/// The edge of a cuboid that faces `offset` and has the larger of the separations `over` its faces.
#[inline]
fn best_edge(offset: Vector, over: Vector) -> Best {
    if over.x > over.y {
        Best { edge: if offset.x < 0.0 { 3 } else { 1 }, support: 0, separation: over.x }
    } else {
        Best { edge: if offset.y < 0.0 { 0 } else { 2 }, support: 0, separation: over.y }
    }
}

/// The edge with the outward normal most opposite to `normal`.
#[inline]
fn facing_edge(cuboid: &Cuboid, normal: Vector) -> Edge {
    let i = if normal.x.abs() > normal.y.abs() {
        if normal.x < 0.0 { 1 } else { 3 }
    } else if normal.y < 0.0 {
        2
    } else {
        0
    };
    edge(cuboid, i)
}

/// The edge `i`, from corner `i` to the next.
#[inline]
fn edge(cuboid: &Cuboid, i: usize) -> Edge {
    let (corners, j) = (corners(cuboid.half), (i + 1) & 3);
    Edge { ends: [corners[i & 3], corners[j]], indices: [i, j] }
}
