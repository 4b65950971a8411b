//! Shapes in the plane: masses and areas, rays against triangles and segments, the convex polygon.

mod curved2;
mod field2;
mod grid2;
mod hull2;

pub use super::Segment as Facet;
pub use curved2::Curved;
pub(super) use grid2::Layout;
pub use hull2::Hull;

pub(crate) use super::primitives::{direction, direction_or};
use super::{Ball, Capsule, Cuboid, RayHit, Segment, Triangle};
use crate::math::{Pose, Vector, max, min};
use core::f64::consts::PI;
use hull2::outline::{cast_ray_polygon, least_depth};
use hull2::wide::{cross, dot, length, sub, wide};

/// Mass, centre of mass and moment of inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MassProperties {
    /// In kg (or, at unit density, the area in m²).
    pub mass: f32,
    /// The centre of mass in the shape's frame, in metres.
    pub center: Vector,
    /// The moment of inertia about the centre of mass, in kg·m².
    pub inertia: f32,
}

impl MassProperties {
    /// All 0.
    pub const ZERO: Self = Self { mass: 0.0, center: Vector::ZERO, inertia: 0.0 };

    /// The properties at `density`. A density of 0 gives no mass but keeps the centre.
    #[inline]
    pub fn scaled(self, density: f32) -> Self {
        Self { mass: self.mass * density, center: self.center, inertia: self.inertia * density }
    }
}

/// The unit normal on the left of a segment; `None` if it has no length.
pub(super) fn face_normal([a, b]: [Vector; 2]) -> Option<Vector> {
    direction(b - a).map(|(axis, _)| axis.perp())
}

/// A multiple of the area between a segment and the origin, positive if its left normal faces away from the
/// origin.
pub(super) fn signed_volume([a, b]: [Vector; 2]) -> f64 {
    -cross(wide(a), wide(b))
}

/// The combined properties of parts at poses. Overlapping parts count twice.
pub(super) fn mass_of_compound<'a>(
    parts: impl Iterator<Item = (&'a Pose, MassProperties)> + Clone,
) -> MassProperties {
    let mass: f32 = parts.clone().map(|(_, part)| part.mass).sum();
    if !(mass > 0.0) {
        return MassProperties::ZERO;
    }
    let placed = parts.map(|(pose, part)| (part, pose.transform(part.center)));
    let moment = placed.clone().fold(Vector::ZERO, |sum, (part, at)| sum + at * part.mass);
    let center = moment * (1.0 / mass);
    let inertia = placed.map(|(part, at)| part.inertia + part.mass * (at - center).length_squared()).sum();
    MassProperties { mass, center, inertia }
}

/// π r², π r⁴ / 2.
pub(super) fn mass_of_ball(ball: &Ball) -> MassProperties {
    let square = f64::from(ball.radius) * f64::from(ball.radius);
    let area = PI * square;
    MassProperties { mass: area as f32, center: Vector::ZERO, inertia: (0.5 * area * square) as f32 }
}

/// With half axis h: a rectangle 2 h × 2 r and two half discs, whose first moment about the diameter is
/// 2 r³ / 3 each: I = rectangle + π r⁴ / 2 + π r² h² + 8 h r³ / 3.
pub(super) fn mass_of_capsule(capsule: &Capsule) -> MassProperties {
    let r = f64::from(capsule.radius);
    let h = 0.5 * length(sub(wide(capsule.b), wide(capsule.a)));
    let (slab, disc) = (4.0 * h * r, PI * r * r);
    let inertia = slab * (h * h + r * r) / 3.0 + disc * (0.5 * r * r + h * h) + 8.0 / 3.0 * h * r * r * r;
    let center = (capsule.a + capsule.b) * 0.5;
    MassProperties { mass: (slab + disc) as f32, center, inertia: inertia as f32 }
}

/// 4 hx hy, m (hx² + hy²) / 3.
pub(super) fn mass_of_cuboid(cuboid: &Cuboid) -> MassProperties {
    let half = wide(cuboid.half);
    let area = 4.0 * half[0] * half[1];
    MassProperties { mass: area as f32, center: Vector::ZERO, inertia: (area * dot(half, half) / 3.0) as f32 }
}

/// Half the cross product of two sides; A (a² + b² + c²) / 36 for sides a, b, c.
pub(super) fn mass_of_triangle(triangle: &Triangle) -> MassProperties {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(wide);
    let [u, v, w] = [sub(b, a), sub(c, b), sub(a, c)];
    let area = 0.5 * cross(u, v).abs();
    let center = Vector::from_array(core::array::from_fn(|i| ((a[i] + b[i] + c[i]) / 3.0) as f32));
    let inertia = area * (dot(u, u) + dot(v, v) + dot(w, w)) / 36.0;
    MassProperties { mass: area as f32, center, inertia: inertia as f32 }
}

/// The centroid, and its distance to the nearest side.
pub(super) fn core_of_triangle(triangle: &Triangle) -> (Vector, f32) {
    let center = (triangle.a + triangle.b + triangle.c) * (1.0 / 3.0);
    match oriented(triangle) {
        Ok((corners, normals)) => (center, least_depth(center, &corners, &normals)),
        Err(_) => (center, 0.0),
    }
}

/// The hit of a ray along the unit vector `direction` on a solid triangle. A triangle without area acts as
/// its longest side.
pub(super) fn cast_ray_triangle(
    triangle: &Triangle,
    origin: Vector,
    direction: Vector,
    max_distance: f32,
    solid: bool,
) -> Option<RayHit> {
    match oriented(triangle) {
        Ok((corners, normals)) => {
            cast_ray_polygon(&corners, &normals, origin, direction, max_distance, solid)
        }
        Err(side) => cast_ray_segment(&side, origin, direction, max_distance),
    }
}

/// The corners counter-clockwise and the normals of the edges; or the longest side of a triangle whose height
/// over that side is below 1e-6 of the side's length.
pub(crate) fn oriented(triangle: &Triangle) -> Result<([Vector; 3], [Vector; 3]), Segment> {
    let Triangle { a, b, c } = *triangle;
    let area = (b - a).perp_dot(c - a);
    let corners = if area < 0.0 { [a, c, b] } else { [a, b, c] };
    let mut longest = (Segment { a, b }, -1.0);
    for i in 0..3 {
        let (p, q) = (corners[i], corners[(i + 1) % 3]);
        let square = (q - p).length_squared();
        if square > longest.1 {
            longest = (Segment { a: p, b: q }, square);
        }
    }
    if area.abs() > 1.0e-6 * longest.1 && longest.1 > 1e-30 {
        let outward = |p: Vector, q: Vector| direction_or(-(q - p).perp(), Vector::Y);
        Ok((corners, core::array::from_fn(|i| outward(corners[i], corners[(i + 1) % 3]))))
    } else {
        Err(longest.0)
    }
}

/// A ray that is cast against many segments. It never passes between segments that share an end: the height
/// of an end over the ray's line is the same number for both.
pub(super) struct FacetRay {
    origin: Vector,
    direction: Vector,
}

impl FacetRay {
    /// The ray along the unit vector `direction`.
    pub(super) fn new(origin: Vector, direction: Vector) -> Self {
        Self { origin, direction }
    }

    /// The hit within `max_distance`, as by [`cast_ray_segment`].
    #[inline]
    pub(super) fn hit(&self, segment: &Segment, max_distance: f32) -> Option<RayHit> {
        cast_ray_segment(segment, self.origin, self.direction, max_distance)
    }
}

/// The crossing of a ray along the unit vector `direction` with a segment, from either side. A ray along the
/// segment's own line hits the nearer end.
pub(super) fn cast_ray_segment(
    segment: &Segment,
    origin: Vector,
    direction: Vector,
    max_distance: f32,
) -> Option<RayHit> {
    let (to_a, to_b) = (segment.a - origin, segment.b - origin);
    // The heights of the ends over the ray's line, counter-clockwise positive.
    let (height_a, height_b) = (direction.perp_dot(to_a), direction.perp_dot(to_b));
    if (height_a > 0.0 && height_b > 0.0) || (height_a < 0.0 && height_b < 0.0) {
        return None;
    }
    let (along_a, along_b) = (to_a.dot(direction), to_b.dot(direction));
    let drop = height_a - height_b;
    let distance = if drop == 0.0 {
        let (near, far) = (min(along_a, along_b), max(along_a, along_b));
        if far < 0.0 { far } else { max(near, 0.0) }
    } else {
        along_a + (along_b - along_a) * (height_a / drop)
    };
    if !(distance >= 0.0 && distance <= max_distance) {
        return None;
    }
    let normal = direction_or((segment.b - segment.a).perp(), -direction);
    let facing = normal.dot(direction);
    let normal = if drop == 0.0 { -direction } else { normal };
    Some(RayHit { distance, normal: if drop != 0.0 && facing > 0.0 { -normal } else { normal } })
}
