//! Simplices and vertices in space. `dim2.rs` has the same functions for the plane.

use super::simplex::{Weights, on_segment, on_triangle};
use crate::math::Vector;
use crate::shape::{Hull, farthest};

/// The weights of the corners of the point of a simplex that is nearest to the origin. `None` if the origin
/// is inside. `is_extended`: the last corner was added, towards the origin, to corners that all had a weight.
#[inline(always)]
pub(super) fn nearest_weights(corners: &[Vector<f64>], is_extended: bool) -> Option<Weights> {
    match *corners {
        [_] => Some([1.0, 0.0, 0.0, 0.0]),
        [a, b] => Some(on_segment(a, b)),
        [a, b, c] => Some(on_triangle(a, b, c)),
        [a, b, c, d] => on_tetrahedron([a, b, c, d], is_extended),
        _ => None,
    }
}

fn on_tetrahedron(p: [Vector<f64>; 4], is_extended: bool) -> Option<Weights> {
    // Each face, followed by the opposite corner. The search adds the last corner towards the origin: the
    // face without it is not the nearest, unless rounding puts the origin inside of the others.
    let faces = [[0, 2, 3, 1], [0, 3, 1, 2], [1, 3, 2, 0], [0, 1, 2, 3]];
    let mut best: Option<(f64, Weights)> = None;
    for [i, j, k, across] in faces {
        if across == 3 && is_extended && best.is_some() {
            break;
        }
        let normal = (p[j] - p[i]).cross(p[k] - p[i]);
        let height = p[across] - p[i];
        let (origin, inside) = (-normal.dot(p[i]), normal.dot(height));
        // A flat tetrahedron has no inside, so every face is a candidate.
        let is_flat = || inside * inside <= 1.0e-24 * normal.length_squared() * height.length_squared();
        if origin * inside > 0.0 && !is_flat() {
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

/// The vertex farthest along a direction.
pub(super) fn farthest_vertex(hull: &Hull, direction: Vector) -> Vector {
    let vertices = hull.vertices();
    vertices[farthest(hull.blocks(), direction).0.min(vertices.len() - 1)]
}
