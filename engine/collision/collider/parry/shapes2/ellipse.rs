//! The ellipse as a custom shape of parry: an exact support map, and closed forms for rays, boxes and mass.

use crate::math::{AdjustPrecision, Scalar, Vector};
use crate::parry::bounding_volume::{Aabb, BoundingSphere};
use crate::parry::mass_properties::MassProperties;
use crate::parry::math::Pose;
use crate::parry::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use crate::parry::shape::{
    FeatureId, PackedFeatureId, PolygonalFeature, PolygonalFeatureMap, Shape, ShapeType, SupportMap,
    TypedShape,
};
use bevy_derive::{Deref, DerefMut};
use bevy_math::primitives::Ellipse;

/// An [`Ellipse`] as a shape of parry.
#[derive(Clone, Copy, Debug, Deref, DerefMut)]
pub struct EllipseColliderShape(pub Ellipse);

impl EllipseColliderShape {
    fn half(&self) -> Vector {
        self.half_size.adjust_precision()
    }
}

impl SupportMap for EllipseColliderShape {
    /// With half axes h, the farthest point along d is h² d / |h d|: the support point of the unit circle
    /// under the map that stretches it into the ellipse.
    fn local_support_point(&self, direction: Vector) -> Vector {
        let half = self.half();
        let stretched = half * direction;
        let length = stretched.length();
        if length > 0.0 { half * stretched / length } else { Vector::X * half }
    }
}

impl PolygonalFeatureMap for EllipseColliderShape {
    /// A short piece of the tangent: parry clips edges, but a curve touches at one point.
    fn local_support_feature(&self, direction: Vector, out_feature: &mut PolygonalFeature) {
        let half = self.half();
        let point = self.local_support_point(direction);
        let tangent = direction.perp().normalize_or(Vector::X) * (half.min_element() * 1.0e-3);
        *out_feature = PolygonalFeature {
            vertices: [point + tangent, point - tangent],
            vids: [PackedFeatureId::vertex(0), PackedFeatureId::vertex(2)],
            fid: PackedFeatureId::face(1),
            num_vertices: 2,
        };
    }
}

impl Shape for EllipseColliderShape {
    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(*self)
    }

    fn scale_dyn(&self, scale: Vector, _: u32) -> Option<Box<dyn Shape>> {
        use crate::math::AsF32;
        Some(Box::new(Self(Ellipse { half_size: (self.half() * scale.abs()).f32() })))
    }

    fn compute_local_aabb(&self) -> Aabb {
        Aabb::new(-self.half(), self.half())
    }

    /// The half extent along an axis is the length of the half axes' components on it.
    fn compute_aabb(&self, position: &Pose) -> Aabb {
        let half = self.half();
        let (x, y) = (position.rotation * (Vector::X * half), position.rotation * (Vector::Y * half));
        let extent = Vector::new(Vector::new(x.x, y.x).length(), Vector::new(x.y, y.y).length());
        Aabb::new(position.translation - extent, position.translation + extent)
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        BoundingSphere::new(Vector::ZERO, self.half().max_element())
    }

    /// The area is π a b, the moment of inertia per mass (a² + b²) / 4.
    fn mass_properties(&self, density: Scalar) -> MassProperties {
        let half = self.half();
        let mass = crate::math::PI * half.x * half.y * density;
        MassProperties::new(Vector::ZERO, mass, mass * half.length_squared() / 4.0)
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
        self.half().min_element()
    }

    fn ccd_angular_thickness(&self) -> Scalar {
        crate::math::PI
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        Some(self)
    }

    fn as_polygonal_feature_map(&self) -> Option<(&dyn PolygonalFeatureMap, Scalar)> {
        Some((self, 0.0))
    }
}

impl RayCast for EllipseColliderShape {
    /// Solves |(o + t d) / h|² = 1 for t: the ray against the unit circle, in stretched coordinates.
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max_time_of_impact: Scalar,
        solid: bool,
    ) -> Option<RayIntersection> {
        let half = self.half();
        let (origin, direction) = (ray.origin / half, ray.dir / half);
        let (a, b, c) = (direction.length_squared(), origin.dot(direction), origin.length_squared() - 1.0);
        if c <= 0.0 && solid {
            return Some(RayIntersection::new(0.0, Vector::ZERO, FeatureId::Unknown));
        }
        let discriminant = b * b - a * c;
        if discriminant < 0.0 || a <= 0.0 || c > 0.0 && b > 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        let time = if c > 0.0 { (-b - root) / a } else { (-b + root) / a };
        if time > max_time_of_impact {
            return None;
        }
        let outward = ((origin + direction * time) / half).normalize_or_zero();
        // For a start inside, the normal points back at the ray, as with parry's shapes.
        let normal = if c > 0.0 { outward } else { -outward };
        Some(RayIntersection::new(time, normal, FeatureId::Face(0)))
    }
}

impl PointQuery for EllipseColliderShape {
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        let half = self.half();
        let is_inside = (point / half).length_squared() <= 1.0;
        if is_inside && solid {
            return PointProjection::new(true, point);
        }
        PointProjection::new(is_inside, nearest_on_ellipse(half, point))
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        (self.project_local_point(point, false), FeatureId::Unknown)
    }
}

/// The point of the ellipse nearest to `point`.
///
/// In the first quadrant the nearest point is x = h² p / (h² + t) for the root t > −min(h²) of
/// F(t) = |h p / (h² + t)|² − 1, which falls with t: bisection finds it from any point (Eberly, "Distance
/// from a point to an ellipse", 2013).
fn nearest_on_ellipse(half: Vector, point: Vector) -> Vector {
    let squared = half * half;
    let p = point.abs();
    // The shorter axis bounds t from below; F is infinite there unless p lies on the longer axis.
    let short = squared.min_element();
    let (mut low, mut high) = (-short, (half * p).length());
    let at = |t: Scalar| half * p / (squared + Vector::splat(t));
    for _ in 0..2 * Scalar::MANTISSA_DIGITS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if at(middle).length_squared() > 1.0 { low = middle } else { high = middle }
    }
    let mut unit = half * p / (squared + Vector::splat(high)).max(Vector::splat(Scalar::MIN_POSITIVE));
    // On the longer axis and within the evolute the root is at the bound. The short component is then the
    // remainder on the unit circle.
    let rest = |other: Scalar| (1.0 - other * other).max(0.0).sqrt();
    if unit.length_squared() < 0.999 {
        if half.x < half.y { unit.x = rest(unit.y) } else { unit.y = rest(unit.x) }
    }
    (half * unit.normalize_or(Vector::X)).copysign(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ellipse(x: f32, y: f32) -> EllipseColliderShape {
        EllipseColliderShape(Ellipse::new(x, y))
    }

    /// Points all around the ellipse.
    fn boundary(shape: &EllipseColliderShape) -> impl Iterator<Item = Vector> + use<> {
        let half = shape.half();
        (0..4000).map(move |i| half * Vector::from_angle(i as Scalar * crate::math::TAU / 4000.0))
    }

    proptest! {
        #[test]
        fn the_support_point_is_the_farthest(x in 0.1f32..5.0, y in 0.1f32..5.0, angle in 0.0f32..6.3) {
            let shape = ellipse(x, y);
            let direction = Vector::from_angle(angle.adjust_precision());
            let support = shape.local_support_point(direction).dot(direction);
            let farthest = boundary(&shape).map(|p| p.dot(direction)).fold(0.0, Scalar::max);
            prop_assert!((support - farthest).abs() < 1.0e-4, "{support} {farthest}");
        }

        #[test]
        fn the_projection_is_the_nearest(
            x in 0.1f32..5.0, y in 0.1f32..5.0, px in -6.0f32..6.0, py in -6.0f32..6.0,
        ) {
            let shape = ellipse(x, y);
            let point = bevy_math::Vec2::new(px, py).adjust_precision();
            let projection = shape.project_local_point(point, false);
            let nearest = boundary(&shape).map(|p| p.distance(point)).fold(Scalar::MAX, Scalar::min);
            prop_assert!((projection.point.distance(point) - nearest).abs() < 5.0e-3);
            prop_assert!(((projection.point / shape.half()).length() - 1.0).abs() < 1.0e-4, "on the boundary");
        }

        #[test]
        fn rays_end_on_the_boundary(x in 0.1f32..5.0, y in 0.1f32..5.0, angle in 0.0f32..6.3, to in -1.5f32..1.5) {
            let shape = ellipse(x, y);
            let direction = Vector::from_angle(angle.adjust_precision());
            let side = direction.perp();
            let reach = shape.local_support_point(side).dot(side);
            let ray = Ray::new(side * reach * to.adjust_precision() - direction * 10.0, direction);
            match shape.cast_local_ray_and_get_normal(&ray, 100.0, true) {
                Some(hit) => {
                    let point = ray.point_at(hit.time_of_impact);
                    prop_assert!(((point / shape.half()).length() - 1.0).abs() < 1.0e-2);
                    prop_assert!(hit.normal.dot(direction) <= 1.0e-3 && (hit.normal.length() - 1.0).abs() < 1.0e-3);
                    prop_assert!(to.abs() < 1.001);
                }
                None => prop_assert!(to.abs() > 0.999),
            }
        }
    }

    #[test]
    fn points_on_the_axes_project_to_the_nearest_side() {
        let shape = ellipse(4.0, 1.0);
        let nearest = |x: Scalar, y: Scalar| shape.project_local_point(Vector::new(x, y), false).point;
        assert!((nearest(0.0, 0.0).y.abs() - 1.0).abs() < 1.0e-4);
        assert!(nearest(3.9, 0.0).distance(Vector::X * 4.0) < 1.0e-3);
        assert!(nearest(0.0, -3.0).distance(Vector::NEG_Y) < 1.0e-3);
        assert!(nearest(-9.0, 0.0).distance(Vector::NEG_X * 4.0) < 1.0e-3);
    }
}
