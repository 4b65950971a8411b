//! Balls and capsules against each other and against what has a closed form for its nearest point.

use crate::manifold::LocalManifold;
use crate::math::{Pose, Vector, clamp, max, min};
use crate::shape::{Capsule, Triangle};

/// Below this sine two capsules count as parallel and touch in two points.
const PARALLEL: f32 = 0.02;

/// A point on the core of either shape, and how far the surfaces lie outside of the cores.
#[derive(Clone, Copy)]
struct Cores {
    a: Vector,
    b: Vector,
    radius_a: f32,
    radius_b: f32,
}

impl Cores {
    /// Adds the contact along a unit normal.
    fn push(&self, normal: Vector, prediction: f32, feature: u32, out: &mut LocalManifold) {
        let separation = normal.dot(self.b - self.a) - self.radius_a - self.radius_b;
        if separation <= prediction {
            let point = (self.a + normal * self.radius_a + self.b - normal * self.radius_b) * 0.5;
            out.push(point, separation, feature);
        } else {
            out.apart = separation;
        }
    }

    /// The contact along the line through the points, or along `fallback` if they coincide.
    fn contact(&self, fallback: Vector, prediction: f32, out: &mut LocalManifold) {
        out.normal = unit_or(self.b - self.a, fallback);
        self.push(out.normal, prediction, 0, out);
    }
}

/// A vector's direction, also if its square is too small or too large for a float.
pub(super) fn unit_or(v: Vector, fallback: Vector) -> Vector {
    let size = v.abs().max_element();
    if !(size > 1.0e-37 && size < f32::MAX) {
        return fallback;
    }
    let v = v * (1.0 / size);
    v * (1.0 / v.length())
}

/// Two balls, the first at the origin.
pub(super) fn balls(radius_a: f32, center: Vector, radius_b: f32, prediction: f32, out: &mut LocalManifold) {
    Cores { a: Vector::ZERO, b: center, radius_a, radius_b }.contact(Vector::Y, prediction, out);
}

/// A capsule (or segment, with no radius) and a ball.
pub(super) fn capsule_ball(
    a: &Capsule,
    center: Vector,
    radius: f32,
    prediction: f32,
    out: &mut LocalManifold,
) {
    let axis = a.b - a.a;
    let square = axis.length_squared();
    let t = if square > 0.0 { clamp((center - a.a).dot(axis) / square, 0.0, 1.0) } else { 0.0 };
    let fallback = unit_or(axis, Vector::X).any_orthonormal();
    let point = a.a + axis * t;
    Cores { a: point, b: center, radius_a: a.radius, radius_b: radius }.contact(fallback, prediction, out);
}

/// A box and a ball; a centre inside leaves by the nearest face.
pub(super) fn cuboid_ball(
    half: Vector,
    center: Vector,
    radius: f32,
    prediction: f32,
    out: &mut LocalManifold,
) {
    let nearest = center.max(-half).min(half);
    let cores = Cores { a: nearest, b: center, radius_a: 0.0, radius_b: radius };
    if center != nearest {
        return cores.contact(Vector::Y, prediction, out);
    }
    let (h, c) = (half.to_array(), center.to_array());
    let mut face = 0;
    for k in 1..3 {
        if h[k] - c[k].abs() < h[face] - c[face].abs() {
            face = k;
        }
    }
    let sign = if c[face] < 0.0 { -1.0 } else { 1.0 };
    let mut on_face = c;
    on_face[face] = sign * h[face];
    out.normal = Vector::AXES[face] * sign;
    Cores { a: Vector::from_array(on_face), ..cores }.push(out.normal, prediction, 0, out);
}

/// A triangle and a ball, from either side; a centre in the plane leaves along the normal.
pub(super) fn triangle_ball(
    t: &Triangle,
    center: Vector,
    radius: f32,
    prediction: f32,
    out: &mut LocalManifold,
) {
    let normal = unit_or((t.b - t.a).cross(t.c - t.a), Vector::Y);
    let nearest = nearest_on_triangle(t, center);
    Cores { a: nearest, b: center, radius_a: 0.0, radius_b: radius }.contact(normal, prediction, out);
}

/// The point of a triangle nearest to another, by Voronoi regions (Ericson, "Real-Time Collision
/// Detection", 5.1.5).
fn nearest_on_triangle(t: &Triangle, p: Vector) -> Vector {
    let (ab, ac, ap) = (t.b - t.a, t.c - t.a, p - t.a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return t.a;
    }
    let bp = p - t.b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return t.b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return t.a + ab * (d1 / (d1 - d3));
    }
    let cp = p - t.c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return t.c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return t.a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return t.b + (t.c - t.b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let k = 1.0 / (va + vb + vc);
    t.a + ab * (vb * k) + ac * (vc * k)
}

/// Two capsules (or segments). Parallel ones touch at both ends of where they run side by side.
pub(super) fn capsules(a: &Capsule, b: &Capsule, pose: &Pose, prediction: f32, out: &mut LocalManifold) {
    let (b0, b1) = (pose.transform(b.a), pose.transform(b.b));
    let (u, v) = (a.b - a.a, b1 - b0);
    let (s, t) = closest_parameters(a.a, u, b0, v);
    let cores = Cores { a: a.a + u * s, b: b0 + v * t, radius_a: a.radius, radius_b: b.radius };
    let crossed = u.cross(v);
    let (uu, vv) = (u.length_squared(), v.length_squared());
    let parallel = !(crossed.length_squared() > PARALLEL * PARALLEL * uu * vv);
    let mut fallback = if parallel {
        unit_or(u, unit_or(v, Vector::X)).any_orthonormal()
    } else {
        unit_or(crossed, Vector::Y)
    };
    if fallback.dot(pose.position) < 0.0 {
        fallback = -fallback;
    }
    if parallel && uu > 0.0 && vv > 0.0 {
        // B's ends along A, held to A: where the two run side by side.
        let ends = [b0, b1].map(|p| clamp((p - a.a).dot(u) / uu, 0.0, 1.0));
        let (low, high) = (min(ends[0], ends[1]), max(ends[0], ends[1]));
        let across = |s: f32| {
            let p = a.a + u * s;
            let q = b0 + v * clamp((p - b0).dot(v) / vv, 0.0, 1.0);
            Cores { a: p, b: q, ..cores }
        };
        if high - low > 0.01 {
            out.normal = unit_or(cores.b - cores.a, fallback);
            for (feature, s) in [(1, low), (2, high)] {
                across(s).push(out.normal, prediction, feature, out);
            }
            out.apart = 0.0;
            return;
        }
    }
    cores.contact(fallback, prediction, out);
    if parallel {
        // Of parallel lines the closest points are found by rounding.
        out.apart = 0.0;
    }
}

/// Where along two segments their closest points are (Ericson, "Real-Time Collision Detection",
/// 5.1.9).
fn closest_parameters(p: Vector, u: Vector, q: Vector, v: Vector) -> (f32, f32) {
    let r = p - q;
    let (a, e, f) = (u.length_squared(), v.length_squared(), v.dot(r));
    let c = u.dot(r);
    match (a > 0.0, e > 0.0) {
        (false, false) => (0.0, 0.0),
        (false, true) => (0.0, clamp(f / e, 0.0, 1.0)),
        (true, false) => (clamp(-c / a, 0.0, 1.0), 0.0),
        (true, true) => {
            let b = u.dot(v);
            let determinant = a * e - b * b;
            let s = if determinant > 1.0e-7 * a * e {
                clamp((b * f - c * e) / determinant, 0.0, 1.0)
            } else {
                0.5
            };
            let t = (b * s + f) / e;
            if t < 0.0 {
                (clamp(-c / a, 0.0, 1.0), 0.0)
            } else if t > 1.0 {
                (clamp((b - c) / a, 0.0, 1.0), 1.0)
            } else {
                (s, t)
            }
        }
    }
}
