//! Bevy's 3D primitives as colliders.
//!
//! Tori, which are not convex, and extrusions have no collider: decompose them as finely as the game needs
//! (`Collider::compound`, `Collider::convex_decomposition_from_mesh`).

use super::super::Collider;
use super::super::constructors::speck;
use super::super::input::checked;
use crate::collision::collider::IntoCollider;
use crate::math::{AdjustPrecision, Scalar, TAU, Vector};
use bevy_math::primitives::{
    Capsule3d, Cone, ConicalFrustum, Cuboid, Cylinder, InfinitePlane3d, Line3d, Plane3d, Polyline3d,
    Segment3d, Sphere, Tetrahedron, Triangle3d,
};
use bevy_math::{Quat, Vec3};

/// Half length of the segment that replaces an infinite line, in metres.
const LINE_HALF_LENGTH: Scalar = 10_000.0;

/// Number of corners of a circle of a conical frustum.
const FRUSTUM_SIDES: u32 = 32;

impl IntoCollider<Collider> for Sphere {
    fn collider(&self) -> Collider {
        Collider::sphere(self.radius.adjust_precision())
    }
}

impl IntoCollider<Collider> for InfinitePlane3d {
    /// The half-space behind the plane.
    fn collider(&self) -> Collider {
        Collider::half_space(self.normal.as_vec3().adjust_precision())
    }
}

impl IntoCollider<Collider> for Plane3d {
    /// A rectangle of two triangles.
    fn collider(&self) -> Collider {
        let turn = Quat::from_rotation_arc(Vec3::Y, self.normal.as_vec3());
        let half = self.half_size;
        let corner = |x: f32, z: f32| (turn * Vec3::new(x * half.x, 0.0, z * half.y)).adjust_precision();
        let corners = vec![corner(1.0, -1.0), corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)];
        Collider::trimesh(corners, vec![[0, 1, 2], [0, 2, 3]])
    }
}

impl IntoCollider<Collider> for Line3d {
    /// A segment of 20 km, since no shape is infinite in both directions.
    fn collider(&self) -> Collider {
        let half = self.direction.as_vec3().adjust_precision() * LINE_HALF_LENGTH;
        Collider::segment(-half, half)
    }
}

impl IntoCollider<Collider> for Segment3d {
    fn collider(&self) -> Collider {
        Collider::segment(self.point1().adjust_precision(), self.point2().adjust_precision())
    }
}

impl IntoCollider<Collider> for Polyline3d {
    fn collider(&self) -> Collider {
        Collider::polyline(self.vertices.iter().map(AdjustPrecision::adjust_precision).collect(), None)
    }
}

impl IntoCollider<Collider> for Triangle3d {
    fn collider(&self) -> Collider {
        let [a, b, c] = self.vertices.map(|v| v.adjust_precision());
        Collider::triangle(a, b, c)
    }
}

impl IntoCollider<Collider> for Tetrahedron {
    /// A flat tetrahedron becomes a tiny ball, with a warning.
    fn collider(&self) -> Collider {
        checked!("from(Tetrahedron)", |input| {
            let points = self.vertices.map(|v| input.point(v.adjust_precision()));
            Collider::convex_hull(points.to_vec()).unwrap_or_else(|| speck(&mut input).into())
        })
    }
}

impl IntoCollider<Collider> for Cuboid {
    fn collider(&self) -> Collider {
        let size = self.half_size.adjust_precision() * 2.0;
        Collider::cuboid(size.x, size.y, size.z)
    }
}

impl IntoCollider<Collider> for Cylinder {
    fn collider(&self) -> Collider {
        Collider::cylinder(self.radius.adjust_precision(), 2.0 * self.half_height.adjust_precision())
    }
}

impl IntoCollider<Collider> for Capsule3d {
    fn collider(&self) -> Collider {
        Collider::capsule(self.radius.adjust_precision(), 2.0 * self.half_length.adjust_precision())
    }
}

impl IntoCollider<Collider> for Cone {
    fn collider(&self) -> Collider {
        Collider::cone(self.radius.adjust_precision(), self.height.adjust_precision())
    }
}

impl IntoCollider<Collider> for ConicalFrustum {
    /// The hull of two regular polygons with 32 corners on the circles. Its volume is 0.6 % too small.
    fn collider(&self) -> Collider {
        checked!("from(ConicalFrustum)", |input| {
            let half = 0.5 * input.length(self.height.adjust_precision());
            let (top, bottom) = (
                input.length_or_zero(self.radius_top.adjust_precision()),
                input.length_or_zero(self.radius_bottom.adjust_precision()),
            );
            let circle = |radius: Scalar, y: Scalar| {
                let corners = if radius > 0.0 { FRUSTUM_SIDES } else { 1 };
                (0..corners).map(move |i| {
                    let (sin, cos) =
                        kernel::math::sin_cos(f64::from(i) / f64::from(FRUSTUM_SIDES) * TAU as f64);
                    Vector::new(cos as Scalar * radius, y, sin as Scalar * radius)
                })
            };
            let points: Vec<_> = circle(top, half).chain(circle(bottom, -half)).collect();
            Collider::convex_hull(points).unwrap_or_else(|| speck(&mut input).into())
        })
    }
}
