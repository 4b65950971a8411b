//! Simplices and vertices in the plane. `dim3.rs` has the same functions for space.

use super::simplex::{Weights, on_segment, on_triangle};
use crate::math::Vector;
use crate::shape::Hull;

/// The weights of the corners of the point of a simplex that is nearest to the origin. `None` if the origin
/// is inside.
#[inline(always)]
pub(super) fn nearest_weights(corners: &[Vector<f64>], _: bool) -> Option<Weights> {
    match *corners {
        [_] => Some([1.0, 0.0, 0.0, 0.0]),
        [a, b] => Some(on_segment(a, b)),
        [a, b, c] => {
            let weights = on_triangle(a, b, c);
            let inside = weights[..3].iter().all(|w| *w > 0.0);
            if !inside {
                return Some(weights);
            }
            // The weights of an inner point are areas, so a triangle without area has no inner point.
            let (ab, ac) = (b - a, c - a);
            let flat = ab.cross(ac).z.abs() <= 1.0e-12 * ab.length() * ac.length();
            flat.then(|| {
                let sides = [[0, 1], [0, 2], [1, 2]];
                let nearest = sides.map(|[i, j]| {
                    let local = on_segment(corners[i], corners[j]);
                    let mut weights = [0.0; 4];
                    (weights[i], weights[j]) = (local[0], local[1]);
                    ((corners[i] * local[0] + corners[j] * local[1]).length_squared(), weights)
                });
                nearest
                    .into_iter()
                    .reduce(|p, q| if q.0 < p.0 { q } else { p })
                    .map_or(weights, |best| best.1)
            })
        }
        _ => None,
    }
}

/// The vertex farthest along a direction.
pub(super) fn farthest_vertex(hull: &Hull, direction: Vector) -> Vector {
    let vertices = hull.vertices();
    let mut best = (vertices[0], vertices[0].dot(direction));
    for v in &vertices[1..] {
        let height = v.dot(direction);
        if height > best.1 {
            best = (*v, height);
        }
    }
    best.0
}
