//! The area, centroid and moment of inertia of a rounded convex polygon, in closed form.

use super::wide::{Point, cross, dot, length, sub, wide};
use crate::math::{Vector, atan2};
use crate::shape::MassProperties;

/// Sums of area, first and second moments about a point.
#[derive(Default)]
struct Moments {
    area: f64,
    first: Point,
    /// ∫ |p|² dA.
    polar: f64,
}

impl Moments {
    /// Adds a part, given its area and its first and polar moments about `at`.
    fn add(&mut self, area: f64, at: Point, first_about: Point, polar_about: f64) {
        // ∫ |at + s|² = polar + 2 at · first + area |at|².
        self.area += area;
        self.first =
            [self.first[0] + area * at[0] + first_about[0], self.first[1] + area * at[1] + first_about[1]];
        self.polar += polar_about + 2.0 * dot(at, first_about) + area * dot(at, at);
    }

    /// The properties about the centroid. `origin` is the point that the sums are about.
    fn finish(&self, origin: Point) -> MassProperties {
        if self.area > 0.0 {
            let center = self.first.map(|v| v / self.area);
            let inertia = self.polar - self.area * dot(center, center);
            MassProperties {
                mass: self.area as f32,
                center: Vector::from_array([(origin[0] + center[0]) as f32, (origin[1] + center[1]) as f32]),
                inertia: if inertia > 0.0 { inertia as f32 } else { 0.0 },
            }
        } else {
            MassProperties::ZERO
        }
    }
}

/// The area of a polygon grown by `radius`: the core as a fan of triangles, a rectangle on each edge, and a
/// sector of the exterior angle θ at each corner (∫ n̂ dθ from n₀ to n₁ is (n₁ − n₀) turned clockwise).
pub(super) fn mass_of_rounded_polygon(vertices: &[Vector], radius: f64) -> MassProperties {
    let origin = wide(vertices[0]);
    let local = |v: Vector| sub(wide(v), origin);
    let mut sum = Moments::default();
    let n = vertices.len();
    for i in 0..n {
        let (p, q, r) = (local(vertices[i]), local(vertices[(i + 1) % n]), local(vertices[(i + 2) % n]));
        // The triangle (origin, p, q): ∫|s|² = area/6 (p·p + p·q + q·q), centroid (p + q)/3.
        let area = 0.5 * cross(p, q);
        let first = [area * (p[0] + q[0]) / 3.0, area * (p[1] + q[1]) / 3.0];
        sum.add(area, [0.0, 0.0], first, area / 6.0 * (dot(p, p) + dot(p, q) + dot(q, q)));
        if radius > 0.0 {
            let (e, f) = (sub(q, p), sub(r, q));
            let (le, lf) = (length(e), length(f));
            let (n0, n1) = ([e[1] / le, -e[0] / le], [f[1] / lf, -f[0] / lf]);
            let middle: Point = core::array::from_fn(|k| 0.5 * (p[k] + q[k] + radius * n0[k]));
            let slab = le * radius;
            sum.add(slab, middle, [0.0, 0.0], slab * (le * le + radius * radius) / 12.0);
            let angle = atan2(cross(n0, n1), dot(n0, n1));
            let (square, cube) = (radius * radius, radius * radius * radius);
            let first = [cube / 3.0 * (n1[1] - n0[1]), -cube / 3.0 * (n1[0] - n0[0])];
            sum.add(0.5 * square * angle, q, first, 0.25 * square * square * angle);
        }
    }
    sum.finish(origin)
}
