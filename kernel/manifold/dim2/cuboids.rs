//! Two cuboids, the most frequent pair. The signs of the offset give the edges to test: four separations are
//! computed, where polygons need sixteen vertices.

use super::super::{LocalManifold, PairInput};
use super::clip::{Facing, Side};
use super::points::Limits;
use super::polygonal::{Edge, NORMALS, corners};
use super::polygons::{Best, cache_of, choose, known_edge, preference};
use crate::math::Vector;
use crate::shape::Cuboid;

/// Fills `out` for two cuboids. Edges and vertices are numbered as for polygons.
pub(in crate::manifold) fn collide(a: &Cuboid, b: &Cuboid, input: PairInput, out: &mut LocalManifold) {
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
