//! What differs in space: mass properties, rays against flat shapes, and the polyhedron. `dim2.rs`
//! exports the same names.

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
        let i = self.inertia;
        Self {
            mass: self.mass * density,
            center: self.center,
            inertia: Inertia {
                xx: i.xx * density,
                yy: i.yy * density,
                zz: i.zz * density,
                xy: i.xy * density,
                xz: i.xz * density,
                yz: i.yz * density,
            },
        }
    }
}

/// A triangle has no inside.
pub(super) fn core_of_triangle(triangle: &Triangle) -> (Vector, f32) {
    ((triangle.a + triangle.b + triangle.c) * (1.0 / 3.0), 0.0)
}

/// The properties of parts at poses together. Parts that overlap count twice.
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

/// Where a ray meets a triangle, from either side; the normal faces the origin of the ray. Rays in the
/// plane of the triangle and degenerate triangles are never hit.
///
/// The point o + t d equals a + u (b − a) + v (c − a); Cramer's rule gives t, u and v (Möller and
/// Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997).
pub fn cast_ray_triangle(
    triangle: &Triangle,
    origin: Vector,
    direction: Vector,
    max_distance: f32,
    _solid: bool,
) -> Option<RayHit> {
    let (e1, e2) = (triangle.b - triangle.a, triangle.c - triangle.a);
    let p = direction.cross(e2);
    let determinant = e1.dot(p);
    if !(determinant.abs() > 1.0e-7 * e1.length() * e2.length()) {
        return None;
    }
    let from_a = origin - triangle.a;
    let q = from_a.cross(e1);
    let (u, v) = (from_a.dot(p) / determinant, direction.dot(q) / determinant);
    let distance = e2.dot(q) / determinant;
    if !(u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance >= 0.0 && distance <= max_distance) {
        return None;
    }
    let normal = e1.cross(e2);
    let length = normal.length();
    let sign = if normal.dot(direction) > 0.0 { -1.0 } else { 1.0 };
    (length > 0.0).then(|| RayHit { distance, normal: normal * (sign / length) })
}

/// Always `None`: in space a segment has no surface to hit.
pub fn cast_ray_segment(_: &Segment, _: Vector, _: Vector, _: f32) -> Option<RayHit> {
    None
}
