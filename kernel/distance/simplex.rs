//! The point of a segment or triangle that is nearest to the origin, as weights of the corners.

use crate::math::Vector;

/// Weights of corners.
pub(super) type Weights = [f64; 4];

pub(super) fn on_segment(a: Vector<f64>, b: Vector<f64>) -> Weights {
    let ab = b - a;
    let square = ab.length_squared();
    let t = if square > 0.0 { -a.dot(ab) / square } else { 0.0 };
    let t = t.clamp(0.0, 1.0);
    [1.0 - t, t, 0.0, 0.0]
}

/// By Voronoi regions (Ericson, "Real-Time Collision Detection", 5.1.5).
pub(super) fn on_triangle(a: Vector<f64>, b: Vector<f64>, c: Vector<f64>) -> Weights {
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
