//! Outlines of convex polygons: simplification, test for convexity, convex hull, and ray hits.

use super::wide::{Point, cross, dot, length, sub, wide};
use crate::math::{Vector, max, min};
use crate::shape::primitives::hit_of_stretch;
use crate::shape::{Aabb, RayHit, ShapeError};

/// Within this distance two points count as one, and a point counts as on the line of its neighbours: 1e-6 of
/// the outline's size, and at least the spacing of `f32` at its coordinates.
pub(super) fn merge_distance(points: &[Vector]) -> f64 {
    let bounds = Aabb::around(points.iter().copied());
    let size = (bounds.max - bounds.min).max_element();
    let far = bounds.min.abs().max(bounds.max.abs()).max_element();
    1.0e-6 * f64::from(size) + 2.0 * f64::from(f32::EPSILON) * f64::from(far)
}

/// The least depth of a point below the edges of a convex polygon; 0 if it is outside.
pub(in crate::shape) fn least_depth(point: Vector, corners: &[Vector], normals: &[Vector]) -> f32 {
    let depths = corners.iter().zip(normals).map(|(corner, normal)| (*corner - point).dot(*normal));
    max(depths.fold(f32::INFINITY, min), 0.0)
}

/// The edges of a closed outline.
pub(super) fn edges(outline: &[Vector]) -> impl Iterator<Item = (Vector, Vector)> + '_ {
    let n = outline.len();
    (0..n).map(move |i| (outline[i], outline[if i + 1 == n { 0 } else { i + 1 }]))
}

/// The outline without points within `tolerance` of the previous point, or of the line of both neighbours and
/// between them. Spikes remain, and are later rejected as not convex.
pub(super) fn simplified(mut outline: Vec<Vector>, tolerance: f64) -> Result<Vec<Vector>, ShapeError> {
    loop {
        let before = outline.len();
        let mut i = 0;
        while outline.len() >= 3 && i < outline.len() {
            let n = outline.len();
            let (p, q, r) = (wide(outline[(i + n - 1) % n]), wide(outline[i]), wide(outline[(i + 1) % n]));
            let (chord, first) = (sub(r, p), sub(q, p));
            let between = dot(first, chord) >= 0.0 && dot(sub(r, q), chord) >= 0.0;
            let off_line = cross(chord, first).abs() <= tolerance * length(chord);
            if length(first) <= tolerance || (off_line && between) {
                outline.remove(i);
            } else {
                i += 1;
            }
        }
        if outline.len() < 3 {
            return Err(ShapeError::Degenerate);
        }
        if outline.len() == before {
            return Ok(outline);
        }
    }
}

/// Whether every corner turns left and the outline goes round once: the directions of its edges pass from the
/// lower into the upper half of the circle exactly once.
pub(super) fn turns_left_once(outline: &[Vector]) -> bool {
    let edge = |i: usize| sub(wide(outline[(i + 1) % outline.len()]), wide(outline[i % outline.len()]));
    let upper = |e: Point| e[1] > 0.0 || (e[1] == 0.0 && e[0] > 0.0);
    let mut rounds = 0;
    for i in 0..outline.len() {
        let (e, f) = (edge(i), edge(i + 1));
        if cross(e, f) <= 0.0 {
            return false;
        }
        rounds += usize::from(!upper(e) && upper(f));
    }
    rounds == 1
}

/// The convex hull, counter-clockwise, of finite points (A. M. Andrew, "Another efficient algorithm for
/// convex hulls in two dimensions", 1979). Fewer than three points if it has no area.
pub(super) fn monotone_chain(points: &[Vector]) -> Vec<Vector> {
    let mut sorted = points.to_vec();
    // Adding 0 turns −0 into 0.
    sorted.iter_mut().for_each(|p| *p += Vector::ZERO);
    sorted.sort_unstable_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    sorted.dedup();
    let mut hull: Vec<Vector> = Vec::with_capacity(sorted.len() + 1);
    let add = |hull: &mut Vec<Vector>, floor: usize, p: Vector| {
        while hull.len() >= floor + 2 {
            let (a, b) = (wide(hull[hull.len() - 2]), wide(hull[hull.len() - 1]));
            if cross(sub(b, a), sub(wide(p), a)) > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(p);
    };
    for p in &sorted {
        add(&mut hull, 0, *p);
    }
    let floor = hull.len().saturating_sub(1);
    for p in sorted.iter().rev().skip(1) {
        add(&mut hull, floor, *p);
    }
    hull.pop();
    hull
}

/// Clips the ray by every edge's line (M. Cyrus and J. Beck, 1978).
pub(in crate::shape) fn cast_ray_polygon(
    vertices: &[Vector],
    normals: &[Vector],
    origin: Vector,
    direction: Vector,
    max_distance: f32,
    solid: bool,
) -> Option<RayHit> {
    let (mut enter, mut exit) = (f32::NEG_INFINITY, f32::INFINITY);
    let (mut first, mut last) = (-direction, direction);
    for (v, n) in vertices.iter().zip(normals) {
        let (height, slope) = ((origin - *v).dot(*n), direction.dot(*n));
        let t = height / -slope;
        if slope < 0.0 {
            if t > enter {
                (enter, first) = (t, *n);
            }
        } else if slope > 0.0 {
            if t < exit {
                (exit, last) = (t, *n);
            }
        } else if height > 0.0 {
            return None;
        }
    }
    hit_of_stretch((enter, exit), max_distance, solid, |entering, _| if entering { first } else { last })
}
