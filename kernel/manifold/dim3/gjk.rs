//! The closest points of two separated polyhedra (Gilbert, Johnson and Keerthi, "A Fast Procedure
//! for Computing the Distance Between Complex Objects in Three-Dimensional Space", 1988).
//!
//! Used where separating axes understate the distance: between two vertices, or a vertex and an edge. The simplex is solved in
//! `f64`, since tetrahedra may be thin.

use super::view::{MatrixPose, View};
use crate::math::{Vector, max};

/// The most iterations. No tested hull needs as many; it only ends the loop.
const MAX_ITERATIONS: usize = 48;
/// The loop stops at this relative gap between the upper and the lower bound of the squared distance.
const GAP: f64 = 1.0e-6;

type Wide = Vector<f64>;

fn widen(v: Vector) -> Wide {
    Wide { x: f64::from(v.x), y: f64::from(v.y), z: f64::from(v.z) }
}

fn narrow(v: Wide) -> Vector {
    Vector { x: v.x as f32, y: v.y as f32, z: v.z as f32 }
}

/// The closest points of two polyhedra.
#[derive(Clone, Copy)]
pub(super) struct Closest {
    /// On A, in A's frame.
    pub a: Vector,
    /// On B, in A's frame.
    pub b: Vector,
    /// The unit normal from A to B.
    pub normal: Vector,
    pub distance: f32,
    /// The vertices that the points lie between.
    pub feature: u32,
}

/// A vertex of the Minkowski difference A − B.
#[derive(Clone, Copy, Default)]
struct Vertex {
    a: Wide,
    b: Wide,
    w: Wide,
    ids: (u32, u32),
    weight: f64,
}

/// The closest points, or `None` if the polyhedra touch or overlap.
pub(super) fn closest(a: &View, b: &View, frame: &MatrixPose) -> Option<Closest> {
    let vertex = |direction: Vector| {
        let (i, j) = (a.support(direction), b.support(-frame.direction_in(direction)));
        let (p, q) = (widen(a.vertices[i]), widen(frame.point(b.vertices[j])));
        Vertex { a: p, b: q, w: p - q, ids: (i as u32, j as u32), weight: 1.0 }
    };
    let start = frame.point(b.center) - a.center;
    let mut simplex = [Vertex::default(); 4];
    simplex[0] = vertex(start);
    let mut count = 1;
    let mut nearest = simplex[0].w;
    let mut scale = nearest.length_squared();
    for _ in 0..MAX_ITERATIONS {
        let square = nearest.length_squared();
        // Distances below the rounding of the vertices count as touching.
        if !(square > 1.0e-13 * scale) {
            return None;
        }
        let new = vertex(narrow(nearest * (-1.0 / square.sqrt())));
        scale = if new.w.length_squared() > scale { new.w.length_squared() } else { scale };
        let known = simplex[..count].iter().any(|v| v.ids == new.ids);
        if known || square - nearest.dot(new.w) <= GAP * square {
            break;
        }
        let mut next = simplex;
        next[count] = new;
        let (next_count, point) = solve(&mut next, count + 1)?;
        if !(point.length_squared() < square) {
            break;
        }
        (simplex, count, nearest) = (next, next_count, point);
    }
    Some(witness(&simplex[..count], nearest))
}

fn witness(simplex: &[Vertex], nearest: Wide) -> Closest {
    let sum = |f: fn(&Vertex) -> Wide| simplex.iter().fold(Wide::ZERO, |s, v| s + f(v) * v.weight);
    let distance = nearest.length();
    // Ids of both features, independent of the order of vertices. They are only compared from step to step.
    let mask = |f: fn(&Vertex) -> u32| {
        let mut bits = 0u32;
        for v in simplex {
            bits |= 1 << (f(v) % 15);
        }
        bits
    };
    Closest {
        a: narrow(sum(|v| v.a)),
        b: narrow(sum(|v| v.b)),
        normal: narrow(nearest * (-1.0 / distance)),
        distance: distance as f32,
        feature: mask(|v| v.ids.0) << 15 | mask(|v| v.ids.1),
    }
}

/// Reduces the simplex to its face nearest to the origin and returns the face's size and closest point. `None` if the origin
/// is inside.
fn solve(simplex: &mut [Vertex; 4], count: usize) -> Option<(usize, Wide)> {
    let w = |i: usize| simplex[i].w;
    let weights = match count {
        1 => [1.0, 0.0, 0.0, 0.0],
        2 => on_segment(w(0), w(1)),
        3 => on_triangle(w(0), w(1), w(2)),
        _ => on_tetrahedron([w(0), w(1), w(2), w(3)])?,
    };
    let mut kept = 0;
    let mut point = Wide::ZERO;
    for (i, weight) in weights.into_iter().enumerate().take(count) {
        if weight > 0.0 {
            simplex[kept] = Vertex { weight, ..simplex[i] };
            point += simplex[kept].w * weight;
            kept += 1;
        }
    }
    Some((kept, point))
}

fn on_segment(a: Wide, b: Wide) -> [f64; 4] {
    let ab = b - a;
    let square = ab.length_squared();
    let t = if square > 0.0 { -a.dot(ab) / square } else { 0.0 };
    let t = t.clamp(0.0, 1.0);
    [1.0 - t, t, 0.0, 0.0]
}

/// Barycentric weights of the point of a triangle nearest to the origin, by Voronoi regions (Ericson,
/// "Real-Time Collision Detection", 5.1.5).
fn on_triangle(a: Wide, b: Wide, c: Wide) -> [f64; 4] {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (-ab.dot(a), -ac.dot(a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0, 0.0];
    }
    let (d3, d4) = (-ab.dot(b), -ac.dot(b));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return [1.0 - t, t, 0.0, 0.0];
    }
    let (d5, d6) = (-ab.dot(c), -ac.dot(c));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0, 0.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return [1.0 - t, 0.0, t, 0.0];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - t, t, 0.0];
    }
    let k = 1.0 / (va + vb + vc);
    let (v, w) = (vb * k, vc * k);
    [1.0 - v - w, v, w, 0.0]
}

fn on_tetrahedron(p: [Wide; 4]) -> Option<[f64; 4]> {
    // Each face with the corner across from it.
    let faces = [[0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2], [1, 3, 2, 0]];
    let mut best: Option<(f64, [f64; 4])> = None;
    for [i, j, k, across] in faces {
        let normal = (p[j] - p[i]).cross(p[k] - p[i]);
        let (origin, inside) = (-normal.dot(p[i]), normal.dot(p[across] - p[i]));
        // A flat tetrahedron has no inside: every face is a candidate.
        let flat = inside.abs() <= 1.0e-12 * normal.length() * (p[across] - p[i]).length();
        if origin * inside > 0.0 && !flat {
            continue;
        }
        let local = on_triangle(p[i], p[j], p[k]);
        let point = p[i] * local[0] + p[j] * local[1] + p[k] * local[2];
        let square = point.length_squared();
        if best.is_none_or(|b| square < b.0) {
            let mut weights = [0.0; 4];
            (weights[i], weights[j], weights[k]) = (local[0], local[1], local[2]);
            best = Some((square, weights));
        }
    }
    best.map(|b| b.1)
}

/// The distance below which closest points of shapes of these extents have no direction. Separating axes are used there.
pub(super) fn resolution(larger: f32, smaller: f32) -> f32 {
    max(1.0e-3 * smaller, 1.0e-5 * larger)
}
