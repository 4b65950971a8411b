//! Queries of one [`Collider`] at a pose: points and rays. The kernel answers for its own shapes,
//! parry for others.

use super::{Collider, dim};
use crate::math::{Scalar, Vector, vector_from_kernel, world_from_kernel, world_to_kernel};
use crate::parry::math::Pose;
use crate::parry::query::Ray;
use crate::physics_transform::{Position, Rotation, world_pose};
use kernel::math::WorldPose;
use kernel::query;
use kernel::shape::Shape;

impl Collider {
    /// The nearest point of the collider to `point`, and whether `point` is inside.
    ///
    /// If `solid`, a point inside is its own projection. Otherwise it is projected onto the boundary. All
    /// points are in world coordinates.
    pub fn project_point(
        &self,
        translation: impl Into<Position>,
        rotation: impl Into<Rotation>,
        point: Vector,
        solid: bool,
    ) -> (Vector, bool) {
        let (translation, rotation) = (translation.into(), rotation.into());
        if let Some((native, pose)) = self.native_at(&translation, &rotation, point) {
            let found = project(native, &pose, point, solid);
            return found.map_or((point, false), |found| (found.0, found.1));
        }
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
    /// A point inside has the distance 0 if `solid`, otherwise minus the distance to the boundary.
    pub fn distance_to_point(
        &self,
        translation: impl Into<Position>,
        rotation: impl Into<Rotation>,
        point: Vector,
        solid: bool,
    ) -> Scalar {
        let (translation, rotation) = (translation.into(), rotation.into());
        if let Some((native, pose)) = self.native_at(&translation, &rotation, point) {
            let found = project(native, &pose, point, solid);
            return found
                .map_or(Scalar::INFINITY, |(_, inside, distance)| if inside { -distance } else { distance });
        }
        let pose = usable_pose(translation, rotation, point);
        pose.map_or(Scalar::INFINITY, |pose| self.shape_scaled().distance_to_point(&pose, point, solid))
    }

    /// Whether `point` is inside the collider.
    pub fn contains_point(
        &self,
        translation: impl Into<Position>,
        rotation: impl Into<Rotation>,
        point: Vector,
    ) -> bool {
        let (translation, rotation) = (translation.into(), rotation.into());
        if let Some((native, pose)) = self.native_at(&translation, &rotation, point) {
            return query::contains_point(native, pose.inverse_transform(world_to_kernel(point)));
        }
        let pose = usable_pose(translation, rotation, point);
        pose.is_some_and(|pose| self.shape_scaled().contains_point(&pose, point))
    }

    /// The first hit of a ray: distance along the ray, and outward normal.
    ///
    /// Distances are in units of the length of `ray_direction`, so in metres for a unit vector. If `solid`, a
    /// ray that starts inside hits at distance 0 with a zero normal. Otherwise it hits the boundary from
    /// within.
    pub fn cast_ray(
        &self,
        translation: impl Into<Position>,
        rotation: impl Into<Rotation>,
        ray_origin: Vector,
        ray_direction: Vector,
        max_distance: Scalar,
        solid: bool,
    ) -> Option<(Scalar, Vector)> {
        let (translation, rotation) = (translation.into(), rotation.into());
        let native = self.native();
        if !matches!(native, Shape::Foreign(_)) {
            let pose = world_pose(&translation, &rotation);
            return cast(native, &pose, [ray_origin, ray_direction], max_distance, solid);
        }
        let (pose, ray) = usable_ray(translation, rotation, ray_origin, ray_direction)?;
        let hit = self.shape_scaled().cast_ray_and_get_normal(&pose, &ray, max_distance, solid)?;
        // Parry also gives normals to rays that start inside.
        let normal = if solid && hit.time_of_impact == 0.0 { Vector::ZERO } else { hit.normal };
        normal.is_finite().then_some((hit.time_of_impact, normal))
    }

    /// Whether a ray hits the collider; a start inside counts. `max_distance` as in
    /// [`cast_ray`](Self::cast_ray).
    pub fn intersects_ray(
        &self,
        translation: impl Into<Position>,
        rotation: impl Into<Rotation>,
        ray_origin: Vector,
        ray_direction: Vector,
        max_distance: Scalar,
    ) -> bool {
        self.cast_ray(translation, rotation, ray_origin, ray_direction, max_distance, true).is_some()
    }

    /// The kernel's shape and its pose, if the kernel answers queries of points. The kernel does not know the
    /// inside of surfaces, which a mesh may have, and accepts no pose or point that is not finite.
    fn native_at(
        &self,
        position: &Position,
        rotation: &Rotation,
        point: Vector,
    ) -> Option<(&Shape, WorldPose)> {
        let native = self.native();
        let is_known = match native {
            Shape::Foreign(_) => false,
            Shape::Composite(composite) => composite.surface().is_none(),
            _ => true,
        };
        let pose = world_pose(position, rotation);
        let finite = dim::pose(position.0, *rotation).is_finite() && point.is_finite();
        (is_known && finite).then_some((native, pose))
    }
}

/// The nearest point of a shape, whether the given point is inside, and the distance.
fn project(shape: &Shape, pose: &WorldPose, point: Vector, solid: bool) -> Option<(Vector, bool, Scalar)> {
    let local = pose.inverse_transform(world_to_kernel(point));
    let found = query::project_point(shape, local, solid, f32::MAX)?;
    if solid && found.is_inside {
        return Some((point, true, 0.0));
    }
    let nearest = world_from_kernel(pose.transform(found.point));
    Some((nearest, found.is_inside, found.distance as Scalar))
}

/// The first hit of a ray, its distance in lengths of the direction.
fn cast(
    shape: &Shape,
    pose: &WorldPose,
    [origin, direction]: [Vector; 2],
    max_distance: Scalar,
    solid: bool,
) -> Option<(Scalar, Vector)> {
    let length = direction.length();
    if !(length > 0.0 && length.is_finite() && pose.rotation.is_finite()) {
        return None;
    }
    let reach = max_distance * length;
    let ray = query::Ray::new(world_to_kernel(origin), world_to_kernel(direction), reach, solid)?;
    let hit = ray.hit(0, shape, pose, ray.max_distance())?;
    Some((hit.distance / length, vector_from_kernel(hit.normal)))
}

/// The pose in parry's type. `None` if the pose or the point is not finite: parry's projections would panic.
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
