//! Queries of one [`Collider`] at a pose: points and rays.

use super::{Collider, dim};
use crate::math::{Scalar, Vector};
use crate::parry::math::Pose;
use crate::parry::query::Ray;
use crate::physics_transform::{Position, Rotation};

impl Collider {
    /// The nearest point of the collider to `point`, and whether `point` is inside.
    ///
    /// If `solid`, a point inside is its own projection; else it is projected onto the boundary. All in
    /// world coordinates.
    pub fn project_point(
        &self,
        translation: impl Into<Position>,
        rotation: impl Into<Rotation>,
        point: Vector,
        solid: bool,
    ) -> (Vector, bool) {
        match usable_pose(translation, rotation, point) {
            Some(pose) => {
                let projection = self.shape_scaled().project_point(&pose, point, solid);
                (projection.point, projection.is_inside)
            }
            None => (point, false),
        }
    }

    /// The distance from `point` to the collider, in metres.
    ///
    /// A point inside has the distance 0 if `solid`, else minus the distance to the boundary.
    pub fn distance_to_point(
        &self,
        translation: impl Into<Position>,
        rotation: impl Into<Rotation>,
        point: Vector,
        solid: bool,
    ) -> Scalar {
        let pose = usable_pose(translation, rotation, point);
        pose.map_or(Scalar::INFINITY, |pose| self.shape_scaled().distance_to_point(&pose, point, solid))
    }

    /// Whether `point` is inside of the collider.
    pub fn contains_point(
        &self,
        translation: impl Into<Position>,
        rotation: impl Into<Rotation>,
        point: Vector,
    ) -> bool {
        let pose = usable_pose(translation, rotation, point);
        pose.is_some_and(|pose| self.shape_scaled().contains_point(&pose, point))
    }

    /// The first hit of a ray: distance along the ray, and outward normal.
    ///
    /// Distances are in units of the length of `ray_direction`, so in metres for a unit vector. A ray
    /// from inside hits at distance 0 with a zero normal if `solid`, else the boundary from within.
    pub fn cast_ray(
        &self,
        translation: impl Into<Position>,
        rotation: impl Into<Rotation>,
        ray_origin: Vector,
        ray_direction: Vector,
        max_distance: Scalar,
        solid: bool,
    ) -> Option<(Scalar, Vector)> {
        let (pose, ray) = usable_ray(translation, rotation, ray_origin, ray_direction)?;
        let hit = self.shape_scaled().cast_ray_and_get_normal(&pose, &ray, max_distance, solid)?;
        hit.normal.is_finite().then_some((hit.time_of_impact, hit.normal))
    }

    /// Whether a ray meets the collider; inside counts. `max_distance` as in [`cast_ray`](Self::cast_ray).
    pub fn intersects_ray(
        &self,
        translation: impl Into<Position>,
        rotation: impl Into<Rotation>,
        ray_origin: Vector,
        ray_direction: Vector,
        max_distance: Scalar,
    ) -> bool {
        usable_ray(translation, rotation, ray_origin, ray_direction)
            .is_some_and(|(pose, ray)| self.shape_scaled().intersects_ray(&pose, &ray, max_distance))
    }
}

/// The pose in parry's type. `None` if it or the point is not finite: parry's projections panic then.
fn usable_pose(
    translation: impl Into<Position>,
    rotation: impl Into<Rotation>,
    point: Vector,
) -> Option<Pose> {
    let pose = dim::pose(translation.into().0, rotation.into());
    (pose.is_finite() && point.is_finite()).then_some(pose)
}

/// Pose and ray in parry's types. `None` if they are not finite or the direction is zero.
fn usable_ray(
    translation: impl Into<Position>,
    rotation: impl Into<Rotation>,
    origin: Vector,
    direction: Vector,
) -> Option<(Pose, Ray)> {
    let pose = usable_pose(translation, rotation, origin)?;
    (direction.is_finite() && direction != Vector::ZERO).then(|| (pose, Ray::new(origin, direction)))
}
