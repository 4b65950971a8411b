//! The regular polygon as a custom shape: any number of sides without a list of corners.

use crate::math::{AdjustPrecision, PI, Scalar, TAU, Vector};
use crate::parry::bounding_volume::{Aabb, BoundingSphere};
use crate::parry::mass_properties::MassProperties;
use crate::parry::query::details::local_ray_intersection_with_support_map_with_params;
use crate::parry::query::gjk::VoronoiSimplex;
use crate::parry::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use crate::parry::shape::{
    FeatureId, PackedFeatureId, PolygonalFeature, PolygonalFeatureMap, Shape, ShapeType, SharedShape,
    SupportMap, TypedShape,
};
use bevy_derive::{Deref, DerefMut};
use bevy_math::primitives::RegularPolygon;

/// A [`RegularPolygon`] as a shape of parry. The first corner is straight up.
#[derive(Clone, Copy, Debug, Deref, DerefMut)]
pub struct RegularPolygonColliderShape(pub RegularPolygon);

impl RegularPolygonColliderShape {
    /// Number of sides, at least 3, since the field is public.
    fn count(&self) -> u32 {
        self.sides.max(3)
    }

    fn radius(&self) -> Scalar {
        self.circumradius().adjust_precision()
    }

    /// The angle between neighbouring corners.
    fn step(&self) -> Scalar {
        TAU / Scalar::from(self.count() as f32)
    }

    /// The i-th corner, counter-clockwise from the top.
    fn corner(&self, i: u32) -> Vector {
        let (sin, cos) = kernel_sin_cos(Scalar::from((i % self.count()) as f32) * self.step());
        Vector::new(-sin, cos) * self.radius()
    }

    /// The corners, counter-clockwise.
    pub(in super::super) fn corners(&self) -> impl Iterator<Item = Vector> + '_ {
        (0..self.count()).map(|i| self.corner(i))
    }

    /// The position of a direction on the circle, counted in corners from the top: 1.5 is the middle of the
    /// second side.
    fn place(&self, direction: Vector) -> Scalar {
        let angle = kernel::math::atan2(f64::from(-direction.x), f64::from(direction.y)) as Scalar;
        (angle / self.step()).rem_euclid(Scalar::from(self.count() as f32))
    }
}

/// The sine and cosine of the kernel: the same bits on every machine.
fn kernel_sin_cos(angle: Scalar) -> (Scalar, Scalar) {
    let (sin, cos) = kernel::math::sin_cos(angle as f64);
    (sin as Scalar, cos as Scalar)
}

impl SupportMap for RegularPolygonColliderShape {
    fn local_support_point(&self, direction: Vector) -> Vector {
        self.corner(self.place(direction).round() as u32)
    }
}

impl PolygonalFeatureMap for RegularPolygonColliderShape {
    fn local_support_feature(&self, direction: Vector, out_feature: &mut PolygonalFeature) {
        let side = self.place(direction).floor() as u32 % self.count();
        let next = (side + 1) % self.count();
        *out_feature = PolygonalFeature {
            vertices: [self.corner(side), self.corner(next)],
            vids: [PackedFeatureId::vertex(feature_code(side)), PackedFeatureId::vertex(feature_code(next))],
            fid: PackedFeatureId::face(feature_code(side)),
            num_vertices: 2,
        };
    }
}

/// Parry packs features into 30 bits.
fn feature_code(index: u32) -> u32 {
    index & 0x3fff_ffff
}

impl Shape for RegularPolygonColliderShape {
    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(*self)
    }

    /// With an even scale the polygon stays regular: it is symmetric about y and, if the number of corners is
    /// even, about x. Otherwise it becomes a convex polygon, if it has few enough corners.
    fn scale_dyn(&self, scale: Vector, _: u32) -> Option<Box<dyn Shape>> {
        let is_symmetric = scale.y > 0.0 || self.count().is_multiple_of(2);
        if scale.x.abs() == scale.y.abs() && is_symmetric {
            let radius = (self.radius() * scale.x.abs()) as f32;
            return Some(Box::new(Self(RegularPolygon::new(radius, self.count()))));
        }
        if self.count() > 1000 {
            return None;
        }
        let corners: Vec<_> = self.corners().map(|c| c * scale).collect();
        Some(SharedShape::convex_hull(&corners)?.clone_dyn())
    }

    fn compute_local_aabb(&self) -> Aabb {
        let reach = |d: Vector| self.local_support_point(d).dot(d);
        Aabb::new(
            Vector::new(-reach(Vector::NEG_X), -reach(Vector::NEG_Y)),
            Vector::new(reach(Vector::X), reach(Vector::Y)),
        )
    }

    fn compute_aabb(&self, position: &crate::parry::math::Pose) -> Aabb {
        let reach = |d: Vector| self.support_point(position, d).dot(d);
        Aabb::new(
            Vector::new(-reach(Vector::NEG_X), -reach(Vector::NEG_Y)),
            Vector::new(reach(Vector::X), reach(Vector::Y)),
        )
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        BoundingSphere::new(Vector::ZERO, self.radius())
    }

    /// n triangles with apex angle 2π/n: the area is ½ n r² sin(2π/n), and the moment of inertia per mass
    /// r² (2 + cos(2π/n)) / 6.
    fn mass_properties(&self, density: Scalar) -> MassProperties {
        let (sin, cos) = kernel_sin_cos(self.step());
        let squared = self.radius() * self.radius();
        let mass = 0.5 * Scalar::from(self.count() as f32) * squared * sin * density;
        MassProperties::new(Vector::ZERO, mass, mass * squared * (2.0 + cos) / 6.0)
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> Scalar {
        self.radius() * kernel_sin_cos(0.5 * self.step()).1
    }

    fn ccd_angular_thickness(&self) -> Scalar {
        PI - self.step()
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        Some(self)
    }

    fn as_polygonal_feature_map(&self) -> Option<(&dyn PolygonalFeatureMap, Scalar)> {
        Some((self, 0.0))
    }
}

impl RayCast for RegularPolygonColliderShape {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max_time_of_impact: Scalar,
        solid: bool,
    ) -> Option<RayIntersection> {
        let simplex = &mut VoronoiSimplex::new();
        local_ray_intersection_with_support_map_with_params(self, simplex, ray, max_time_of_impact, solid)
    }
}

impl PointQuery for RegularPolygonColliderShape {
    /// The nearest side is the one in the point's sector, by symmetry.
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        let side = self.place(point).floor() as u32;
        let (a, b) = (self.corner(side), self.corner(side + 1));
        let is_inside = (b - a).perp_dot(point - a) >= 0.0;
        if is_inside && solid {
            return PointProjection::new(true, point);
        }
        let along = (point - a).dot(b - a) / a.distance_squared(b);
        PointProjection::new(is_inside, a.lerp(b, along.clamp(0.0, 1.0)))
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        (self.project_local_point(point, false), FeatureId::Unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parry::shape::ConvexPolygon;

    #[test]
    fn it_is_the_polygon_of_its_corners() {
        use crate::parry::shape::Segment;
        for sides in [3, 4, 5, 6, 17, 100] {
            let shape = RegularPolygonColliderShape(RegularPolygon::new(2.0, sides));
            let corners: Vec<_> = shape.corners().collect();
            let oracle = ConvexPolygon::from_convex_polyline(corners.clone()).expect("a convex outline");
            let (ours, theirs) = (shape.mass_properties(3.0), oracle.mass_properties(3.0));
            assert!((ours.mass() - theirs.mass()).abs() < 1.0e-3 * theirs.mass());
            let inertia = (ours.principal_inertia(), theirs.principal_inertia());
            assert!((inertia.0 - inertia.1).abs() < 1.0e-3 * inertia.1, "{sides}: {inertia:?}");
            for i in 0..200 {
                let direction = Vector::from_angle(i as Scalar * 0.173);
                let reach = [shape.local_support_point(direction), oracle.local_support_point(direction)];
                assert!((reach[0].dot(direction) - reach[1].dot(direction)).abs() < 1.0e-4);
                let point = direction * (i as Scalar * 0.021);
                let projection = shape.project_local_point(point, false);
                let to_side = |k: usize| {
                    let side = Segment::new(corners[k], corners[(k + 1) % corners.len()]);
                    side.distance_to_local_point(point, true)
                };
                let nearest = (0..corners.len()).map(to_side).fold(Scalar::MAX, Scalar::min);
                assert!((projection.point.distance(point) - nearest).abs() < 1.0e-4, "{sides} {point}");
                assert_eq!(projection.is_inside, oracle.contains_local_point(point), "{sides} {point}");
            }
        }
    }
}
