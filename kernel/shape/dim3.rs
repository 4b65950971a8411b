//! The three-dimensional part of shapes: mass properties, rays against flat shapes, and the polyhedron.
//! `dim2.rs` exports the same names.

mod curved3;
mod field3;
mod grid3;
mod hull3;
#[cfg(test)]
#[path = "tests_rays3.rs"]
mod rays;

pub use super::Triangle as Facet;
pub use curved3::Curved;
pub(super) use grid3::Layout;
pub use hull3::{Edge, Face, Hull};
pub(crate) use hull3::{EdgeBlock, FaceBlock, farthest, largest};

use super::primitives::direction;
pub(crate) use super::primitives::nearest_fraction;
use super::{Ball, Capsule, Cuboid, RayHit, Segment, Triangle};
use crate::math::{Inertia, Pose, Vector};
use core::f32::consts::PI;

/// Mass, centre of mass and moment of inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MassProperties {
    /// In kg.
    pub mass: f32,
    /// The centre of mass in the shape's frame, in metres.
    pub center: Vector,
    /// The inertia tensor about the centre of mass, along the shape's axes, in kg·m².
    pub inertia: Inertia,
}

/// The unit normal of a triangle, counter-clockwise from outside; `None` if it has no area.
pub(super) fn face_normal([a, b, c]: [Vector; 3]) -> Option<Vector> {
    direction((b - a).cross(c - a)).map(|(normal, _)| normal)
}

/// A multiple of the volume between a triangle and the origin, positive if it faces away from the origin.
pub(super) fn signed_volume([a, b, c]: [Vector; 3]) -> f64 {
    f64::from(a.dot(b.cross(c)))
}

impl MassProperties {
    /// All 0.
    pub const ZERO: Self = Self { mass: 0.0, center: Vector::ZERO, inertia: Inertia::ZERO };

    /// The properties at `density`.
    pub fn scaled(self, density: f32) -> Self {
        Self { mass: self.mass * density, center: self.center, inertia: self.inertia.scaled(density) }
    }
}

/// A triangle has no inside.
pub(super) fn core_of_triangle(triangle: &Triangle) -> (Vector, f32) {
    ((triangle.a + triangle.b + triangle.c) * (1.0 / 3.0), 0.0)
}

/// The combined properties of parts at poses. Overlapping parts count twice.
pub(super) fn mass_of_compound<'a>(
    parts: impl Iterator<Item = (&'a Pose, MassProperties)> + Clone,
) -> MassProperties {
    let mass: f32 = parts.clone().map(|(_, part)| part.mass).sum();
    if !(mass > 0.0) {
        return MassProperties::ZERO;
    }
    let moment =
        parts.clone().fold(Vector::ZERO, |sum, (pose, part)| sum + pose.transform(part.center) * part.mass);
    let center = moment * (1.0 / mass);
    let inertia = parts.fold(Inertia::ZERO, |sum, (pose, part)| {
        // Steiner's theorem: a part at r from the centre adds m (r² − r rᵀ) to its own, turned inertia.
        let r = pose.transform(part.center) - center;
        let square = Inertia::from_diagonal(Vector::ONE * (part.mass * r.length_squared()));
        let own = part.inertia.rotated(pose.rotation);
        let mut sum = sum;
        for (out, part_of, square, outer) in [
            (&mut sum.xx, own.xx, square.xx, r.x * r.x),
            (&mut sum.yy, own.yy, square.yy, r.y * r.y),
            (&mut sum.zz, own.zz, square.zz, r.z * r.z),
            (&mut sum.xy, own.xy, 0.0, r.x * r.y),
            (&mut sum.xz, own.xz, 0.0, r.x * r.z),
            (&mut sum.yz, own.yz, 0.0, r.y * r.z),
        ] {
            *out += part_of + square - part.mass * outer;
        }
        sum
    });
    MassProperties { mass, center, inertia }
}

/// The mass properties of a ball of 1 kg/m³: m = 4/3 π r³, I = 2/5 m r².
pub fn mass_of_ball(ball: &Ball) -> MassProperties {
    let square = ball.radius * ball.radius;
    let mass = 4.0 / 3.0 * PI * square * ball.radius;
    let inertia = Inertia::from_diagonal(Vector::ONE * (0.4 * mass * square));
    MassProperties { mass, center: Vector::ZERO, inertia }
}

/// The mass properties of a capsule of 1 kg/m³: a cylinder of length h and two half balls.
///
/// Along the axis I = ½ m_c r² + 2/5 m_b r². Across it I = m_c (r²/4 + h²/12) + m_b (2/5 r² + h²/4 +
/// 3/8 h r), where a half ball has its centre of mass 3/8 r from its flat side (Steiner's theorem).
pub fn mass_of_capsule(capsule: &Capsule) -> MassProperties {
    let axis = capsule.b - capsule.a;
    let (h, r) = (axis.length(), capsule.radius);
    let cylinder = PI * r * r * h;
    let ball = 4.0 / 3.0 * PI * r * r * r;
    let along = r * r * (0.5 * cylinder + 0.4 * ball);
    let across =
        cylinder * (0.25 * r * r + h * h / 12.0) + ball * (0.4 * r * r + 0.25 * h * h + 0.375 * h * r);
    // I = across · 1 + (along − across) u uᵀ for the unit axis u.
    let u = if h > 0.0 { axis * (1.0 / h) } else { Vector::Y };
    let k = along - across;
    let inertia = Inertia {
        xx: across + k * u.x * u.x,
        yy: across + k * u.y * u.y,
        zz: across + k * u.z * u.z,
        xy: k * u.x * u.y,
        xz: k * u.x * u.z,
        yz: k * u.y * u.z,
    };
    MassProperties { mass: cylinder + ball, center: (capsule.a + capsule.b) * 0.5, inertia }
}

/// The mass properties of a cuboid of 1 kg/m³: I_x = m (h_y² + h_z²) / 3 for half extents h.
pub fn mass_of_cuboid(cuboid: &Cuboid) -> MassProperties {
    let h = cuboid.half;
    let mass = 8.0 * h.x * h.y * h.z;
    let s = h.scale(h) * (mass / 3.0);
    let inertia = Inertia::from_diagonal(Vector { x: s.y + s.z, y: s.x + s.z, z: s.x + s.y });
    MassProperties { mass, center: Vector::ZERO, inertia }
}

/// Zero: a triangle in space has no inside.
pub fn mass_of_triangle(_: &Triangle) -> MassProperties {
    MassProperties::ZERO
}

/// The hit of a ray on a triangle, from either side. The normal faces the origin of the ray. Degenerate
/// triangles, and triangles whose plane contains the ray, are never hit.
pub fn cast_ray_triangle(
    triangle: &Triangle,
    origin: Vector,
    direction: Vector,
    max_distance: f32,
    _solid: bool,
) -> Option<RayHit> {
    FacetRay::new(origin, direction).hit(triangle, max_distance)
}

/// A ray that is cast against many triangles. It never passes between triangles that share an edge or a
/// vertex.
///
/// Space is sheared so that the ray becomes the z axis, and the three edges are tested in the xy plane (Woop,
/// Benthin and Wald, "Watertight Ray/Triangle Intersection", 2013). The shear of a vertex depends on the
/// vertex alone, and products of two `f32` are exact in `f64`, so neighbours see the same sign at their edge.
pub(super) struct FacetRay {
    origin: Vector,
    direction: Vector,
    /// The axes that become x, y and z. The direction is largest along z.
    axes: [usize; 3],
    /// The shear of x and y, and the scale of z.
    shear: [f32; 3],
}

impl FacetRay {
    /// The ray along the unit vector `direction`.
    pub(super) fn new(origin: Vector, direction: Vector) -> Self {
        let d = direction.to_array();
        let z = (1..3).fold(0, |best, i| if d[i].abs() > d[best].abs() { i } else { best });
        let [x, y] = [(z + 1) % 3, (z + 2) % 3];
        Self { origin, direction, axes: [x, y, z], shear: [d[x] / d[z], d[y] / d[z], 1.0 / d[z]] }
    }

    /// The hit within `max_distance`, as by [`cast_ray_triangle`].
    #[inline]
    pub(super) fn hit(&self, triangle: &Triangle, max_distance: f32) -> Option<RayHit> {
        let [x, y, z] = self.axes;
        let corners = [triangle.a, triangle.b, triangle.c];
        let [a, b, c] = corners.map(|corner| {
            let from = (corner - self.origin).to_array();
            let sheared = [from[x] - self.shear[0] * from[z], from[y] - self.shear[1] * from[z]];
            (sheared.map(f64::from), f64::from(self.shear[2] * from[z]))
        });
        let twice_area = |(p, _): ([f64; 2], f64), (q, _): ([f64; 2], f64)| p[0] * q[1] - p[1] * q[0];
        // The weights of the corners, times the determinant.
        let weights = [twice_area(b, c), twice_area(c, a), twice_area(a, b)];
        if weights.iter().any(|w| *w < 0.0) && weights.iter().any(|w| *w > 0.0) {
            return None;
        }
        let determinant = weights.iter().sum::<f64>();
        let heights = [a.1, b.1, c.1];
        let along = weights.iter().zip(heights).map(|(weight, height)| weight * height).sum::<f64>();
        let distance = (along / determinant) as f32;
        // NaN if the determinant is 0.
        if !(distance >= 0.0 && distance <= max_distance) {
            return None;
        }
        // A facet that the ray hits has an area, but the area may be too small for `f32`.
        let normal = face_normal(corners).unwrap_or(-self.direction);
        let is_behind = normal.dot(self.direction) > 0.0;
        Some(RayHit { distance, normal: if is_behind { -normal } else { normal } })
    }
}

/// Always `None`: in space a segment has no surface to hit.
pub fn cast_ray_segment(_: &Segment, _: Vector, _: Vector, _: f32) -> Option<RayHit> {
    None
}
