//! Balls and capsules against each other and against shapes with a closed form for the closest point.

use crate::manifold::{LocalManifold, PairInput};
use crate::math::{Vector, clamp, max, min};
use crate::shape::{Ball, Capsule, Cuboid, Triangle, nearest_fraction};
use crate::tuning::manifold::{CROSSED, LINE_SINE, MARGIN, ROUNDING, SAME};

/// The closest points of both cores, and the radii.
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
            out.gap = separation;
        }
    }

    /// The contact along the line through the points, or along `fallback` if their distance is
    /// within `rounding`.
    fn contact(&self, fallback: Vector, rounding: f32, prediction: f32, out: &mut LocalManifold) {
        out.normal = self.direction_or(fallback, rounding);
        self.push(out.normal, prediction, 0, out);
    }

    /// The direction from A's point to B's, or `fallback` as above.
    fn direction_or(&self, fallback: Vector, rounding: f32) -> Vector {
        let between = self.b - self.a;
        if between.abs().max_element() > rounding { unit_or(between, fallback) } else { fallback }
    }
}

/// The distance below which the difference of points computed from `points` has no direction.
fn rounding_of(points: &[Vector]) -> f32 {
    ROUNDING * points.iter().fold(0.0, |size, p| max(size, p.abs().max_element()))
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
pub(super) fn balls(a: &Ball, b: &Ball, input: PairInput, out: &mut LocalManifold) {
    let cores = Cores { a: Vector::ZERO, b: input.pose.position, radius_a: a.radius, radius_b: b.radius };
    cores.contact(Vector::Y, 0.0, input.prediction, out);
}

/// A capsule (or segment, with no radius) and a ball.
pub(super) fn capsule_ball(a: &Capsule, &Ball { radius }: &Ball, input: PairInput, out: &mut LocalManifold) {
    let center = input.pose.position;
    let axis = a.b - a.a;
    let t = nearest_fraction(a.a, a.b, center);
    let fallback = unit_or(axis, Vector::X).any_orthonormal();
    let point = a.a + axis * t;
    // A centre within rounding of the axis counts as on it.
    let rounding = rounding_of(&[a.a, a.b]);
    let cores = Cores { a: point, b: center, radius_a: a.radius, radius_b: radius };
    cores.contact(fallback, rounding, input.prediction, out);
}

/// A box and a ball. For a centre inside, the normal is the nearest face's.
pub(super) fn cuboid_ball(a: &Cuboid, b: &Ball, input: PairInput, out: &mut LocalManifold) {
    let (half, radius) = (a.half, b.radius);
    let center = input.pose.position;
    let nearest = center.max(-half).min(half);
    let cores = Cores { a: nearest, b: center, radius_a: 0.0, radius_b: radius };
    if center != nearest {
        // The centre is clamped to the box without rounding.
        return cores.contact(Vector::Y, 0.0, input.prediction, out);
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
    Cores { a: Vector::from_array(on_face), ..cores }.push(out.normal, input.prediction, 0, out);
}

/// A triangle and a ball, from either side. For a centre in the plane the normal is the triangle's.
pub(super) fn triangle_ball(t: &Triangle, b: &Ball, input: PairInput, out: &mut LocalManifold) {
    let center = input.pose.position;
    let mut normal = match face(t) {
        Some(normal) => normal,
        None => {
            let sides = [t.b - t.a, t.c - t.b, t.a - t.c];
            let longest = sides
                .into_iter()
                .fold(Vector::ZERO, |l, s| if s.length_squared() > l.length_squared() { s } else { l });
            unit_or(longest, Vector::X).any_orthonormal()
        }
    };
    if normal.dot(center - t.a) < 0.0 {
        normal = -normal;
    }
    let nearest = nearest_on_triangle(t, center);
    let cores = Cores { a: nearest, b: center, radius_a: 0.0, radius_b: b.radius };
    cores.contact(normal, rounding_of(&[t.a, t.b, t.c]), input.prediction, out);
}

/// A triangle's unit normal; `None` if its corners are on a line, or in one place.
fn face(t: &Triangle) -> Option<Vector> {
    let (ab, ac) = (t.b - t.a, t.c - t.a);
    let cross = ab.cross(ac);
    let size = ab.length() * ac.length();
    // The third side may be the shortest. A NaN fails the comparison.
    let is_face = cross.length() > ROUNDING * max(size, max(ab.length_squared(), ac.length_squared()));
    is_face.then(|| unit_or(cross, Vector::Y))
}

/// The point of a triangle nearest to another, by Voronoi regions (Ericson, "Real-Time Collision
/// Detection", 5.1.5).
fn nearest_on_triangle(t: &Triangle, p: Vector) -> Vector {
    if face(t).is_none() {
        return nearest_on_sides(t, p);
    }
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

/// The point of a triangle's sides nearest to another.
fn nearest_on_sides(t: &Triangle, p: Vector) -> Vector {
    let (mut nearest, mut least) = (t.a, f32::INFINITY);
    for (from, to) in [(t.a, t.b), (t.b, t.c), (t.c, t.a)] {
        let point = from + (to - from) * nearest_fraction(from, to, p);
        let distance = (p - point).length_squared();
        if distance < least {
            (nearest, least) = (point, distance);
        }
    }
    nearest
}

/// Two capsules (or segments). Parallel capsules get a point at each end of the range in which they are side
/// by side.
pub(super) fn capsules(a: &Capsule, b: &Capsule, input: PairInput, out: &mut LocalManifold) {
    let PairInput { pose, prediction, .. } = input;
    let (b0, b1) = (pose.transform(b.a), pose.transform(b.b));
    let (u, v) = (a.b - a.a, b1 - b0);
    let (s, t) = closest_parameters(a.a, u, b0, v);
    let cores = Cores { a: a.a + u * s, b: b0 + v * t, radius_a: a.radius, radius_b: b.radius };
    let crossed = u.cross(v);
    let (uu, vv) = (u.length_squared(), v.length_squared());
    let is_within = |sine: f32| !(crossed.length_squared() > sine * sine * uu * vv);
    let parallel = is_within(MARGIN);
    let mut fallback = if parallel {
        unit_or(u, unit_or(v, Vector::X)).any_orthonormal()
    } else {
        unit_or(crossed, Vector::Y)
    };
    let rounding = rounding_of(&[a.a, a.b, b0, b1]);
    // The normal of coinciding cores points to the side of B. Its distance is more accurate than
    // its direction.
    let between = fallback.dot(cores.b - cores.a);
    let side = if between.abs() > 0.05 * rounding { between } else { fallback.dot(pose.position) };
    if side < 0.0 {
        fallback = -fallback;
    }
    let lines = Lines::new(a.a, u, [b0, b0 + v], v);
    if is_within(LINE_SINE)
        && cores.touch(&lines, parallel, |middle| middle.direction_or(fallback, rounding), prediction, out)
    {
        return;
    }
    if !parallel && s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0 {
        // Between the ends of both, the normal is across both at any distance.
        out.normal = fallback;
        return cores.push(fallback, prediction, 0, out);
    }
    cores.contact(fallback, rounding, prediction, out);
    if parallel {
        // The closest points of parallel lines are found by rounding.
        out.gap = 0.0;
    }
}

/// A line from a point along a vector, another between two points, and their squared lengths.
pub(super) struct Lines {
    a: Vector,
    pub u: Vector,
    b: [Vector; 2],
    pub v: Vector,
    pub uu: f32,
    pub vv: f32,
}

impl Lines {
    pub fn new(a: Vector, u: Vector, b: [Vector; 2], v: Vector) -> Self {
        Self { a, u, b, v, uu: u.length_squared(), vv: v.length_squared() }
    }

    /// The range of A, as 0…1, in which B is beside it, if it is long enough. Both lines have a length.
    pub fn shared(&self) -> Option<[f32; 2]> {
        let ends = self.b.map(|p| clamp((p - self.a).dot(self.u) / self.uu, 0.0, 1.0));
        let (low, high) = (min(ends[0], ends[1]), max(ends[0], ends[1]));
        let shared = (high - low) * (high - low) * self.uu;
        (shared > SAME * SAME * min(self.uu, self.vv)).then_some([low, high])
    }

    /// The point of A at a share, and the point of B beside it.
    pub fn at(&self, t: f32) -> [Vector; 2] {
        let on_a = self.a + self.u * t;
        [on_a, self.b[0] + self.v * clamp((on_a - self.b[0]).dot(self.v) / self.vv, 0.0, 1.0)]
    }
}

impl Cores {
    /// The contact of two capsules that are nearly parallel, with a point at each end of the range in which
    /// both are side by side; `self` has their closest points. The normal is taken in the middle of the
    /// range.
    fn touch(
        &self,
        lines: &Lines,
        parallel: bool,
        normal_or: impl Fn(&Self) -> Vector,
        prediction: f32,
        out: &mut LocalManifold,
    ) -> bool {
        if lines.uu == 0.0 || lines.vv == 0.0 {
            return false;
        }
        let Some([low, high]) = lines.shared() else { return false };
        let across = |t: f32| {
            let [a, b] = lines.at(t);
            Self { a, b, ..*self }
        };
        let [first, last] = [low, high].map(across);
        let between = self.b - self.a;
        let sway = [first, last].map(|end| ((end.b - end.a) - between).length_squared());
        let size = CROSSED * min(between.length(), self.radius_a + self.radius_b);
        let is_line = parallel || max(sway[0], sway[1]) < size * size;
        if !is_line {
            return false;
        }
        out.normal = normal_or(&across(0.5 * (low + high)));
        for (feature, ends) in [(1, first), (2, last)] {
            ends.push(out.normal, prediction, feature, out);
        }
        out.gap = 0.0;
        true
    }
}

/// The closest points of two segments, as fractions along them (Ericson, "Real-Time Collision Detection",
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
