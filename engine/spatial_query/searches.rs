//! The searches of [`SpatialQuery`](super::SpatialQuery): along a ray, along a cast shape, around a point.

use super::{
    RayHitData, ShapeCastConfig, ShapeHitData, SpatialQueryFilter,
    recent::Recent,
    traversal::{Candidate, Found, Scene, Walk},
    world::World,
};
use crate::{
    collision::collider::{Collider, ForeignCast, cast_foreign},
    math::{
        AdjustPrecision, Dir, Scalar, Vector, VectorF32, to_f32, vector_from_kernel, world_from_kernel,
        world_to_kernel,
    },
    physics_transform::{Position, Rotation, pose_from_kernel, world_pose},
};
use kernel::{
    math::{WorldPose, WorldVector},
    query::{CastConfig, Ray as KernelRay, ShapeCast, project_point},
    shape::Shape,
};

/// A search of the present colliders, with a filter.
pub(super) struct Search<'a> {
    world: &'a World<'a, 'a>,
    recent: &'a Recent,
    filter: &'a SpatialQueryFilter,
}

impl<'a> Search<'a> {
    pub(super) fn new(world: &'a World, recent: &'a Recent, filter: &'a SpatialQueryFilter) -> Self {
        Self { world, recent, filter }
    }

    /// `None` for a ray that hits nothing.
    pub(super) fn ray(
        self,
        origin: Vector,
        direction: Dir,
        max_distance: Scalar,
        solid: bool,
    ) -> Option<RaySearch<'a>> {
        let direction = vector_of(direction);
        let ray = KernelRay::new(world_to_kernel(origin), world_to_kernel(direction), max_distance, solid)?;
        Some(RaySearch { search: self, ray, origin, direction, solid })
    }

    /// `None` for a cast that hits nothing.
    pub(super) fn shape(
        self,
        (shape, pose): (&'a Collider, (Position, Rotation)),
        direction: Dir,
        config: &'a ShapeCastConfig,
    ) -> Option<CastSearch<'a>> {
        let direction = vector_of(direction);
        let start: WorldPose = world_pose(&pose.0, &pose.1);
        let along: WorldVector = world_to_kernel(direction);
        let wanted = CastConfig {
            target_distance: to_f32(config.target_distance),
            ignore_origin_penetration: config.ignore_origin_penetration,
            compute_contact_on_penetration: config.compute_contact_on_penetration,
        };
        let cast = ShapeCast::new(shape.native(), &start, along, config.max_distance, &wanted)?;
        // Parry takes a unit rotation.
        let pose = pose_from_kernel(start);
        Some(CastSearch { search: self, cast, shape, pose, direction, config })
    }

    pub(super) fn near(self, point: Vector, solid: bool) -> NearSearch<'a> {
        NearSearch { search: self, point, solid }
    }

    pub(super) fn scene(&self) -> Scene<'_> {
        Scene { tables: &self.world.colliders, recent: self.recent }
    }

    /// The collider component of a candidate, if it passes the filter. Only parry's shapes need it.
    pub(super) fn component(&self, candidate: &Candidate) -> Option<&Collider> {
        self.world.component(candidate.entity)
    }

    pub(super) fn passes(&self, candidate: &Candidate) -> bool {
        self.filter.test(candidate.entity, candidate.layers)
    }
}

pub(super) fn is_foreign(shape: &Shape) -> bool {
    matches!(shape, Shape::Foreign(_))
}

/// A search along a ray.
pub(super) struct RaySearch<'a> {
    search: Search<'a>,
    ray: KernelRay,
    origin: Vector,
    direction: Vector,
    solid: bool,
}

impl Walk<Vector> for RaySearch<'_> {
    fn walk(&self, visit: &mut dyn FnMut(&Candidate, Scalar) -> Scalar) {
        self.search.scene().along_ray(&self.ray, visit);
    }

    fn hit(&self, candidate: &Candidate, limit: Scalar) -> Option<Found<Vector>> {
        if !self.search.passes(candidate) {
            return None;
        }
        if is_foreign(candidate.shape) {
            let (position, rotation) = candidate.components();
            let collider = self.search.component(candidate)?;
            let hit =
                collider.cast_ray(position, rotation, self.origin, self.direction, limit, self.solid)?;
            return Some(Found::new(candidate, hit.0, hit.1));
        }
        let hit = self.ray.hit(candidate.order, candidate.shape, &candidate.pose, limit)?;
        Some(Found::new(candidate, hit.distance, vector_from_kernel(hit.normal)))
    }
}

/// Points and normals of the hit of a cast shape: on the collider, then on the shape.
#[derive(Clone, Copy)]
pub(super) struct Touch {
    points: [Vector; 2],
    normals: [Vector; 2],
}

/// A search along a cast shape.
pub(super) struct CastSearch<'a> {
    search: Search<'a>,
    cast: ShapeCast<'a>,
    shape: &'a Collider,
    pose: (Position, Rotation),
    direction: Vector,
    config: &'a ShapeCastConfig,
}

impl Walk<Touch> for CastSearch<'_> {
    fn walk(&self, visit: &mut dyn FnMut(&Candidate, Scalar) -> Scalar) {
        self.search.scene().along_cast(&self.cast, visit);
    }

    fn hit(&self, candidate: &Candidate, limit: Scalar) -> Option<Found<Touch>> {
        if !self.search.passes(candidate) {
            return None;
        }
        if is_foreign(candidate.shape) || is_foreign(self.shape.native()) {
            let cast = ForeignCast {
                direction: self.direction,
                max_distance: limit,
                target_distance: self.config.target_distance,
                compute_contact: self.config.compute_contact_on_penetration,
                ignore_penetration: self.config.ignore_origin_penetration,
            };
            let collider = self.search.component(candidate)?;
            let hit = cast_foreign((collider, candidate.components()), (self.shape, self.pose), &cast)?;
            return Some(Found::new(
                candidate,
                hit.distance,
                Touch { points: hit.points, normals: hit.normals },
            ));
        }
        let hit = self.cast.hit(candidate.order, candidate.shape, &candidate.pose, limit)?;
        let normal = vector_from_kernel(hit.normal);
        let touch = Touch { points: hit.points.map(world_from_kernel), normals: [normal, -normal] };
        Some(Found::new(candidate, hit.distance, touch))
    }
}

/// A search around a point.
pub(super) struct NearSearch<'a> {
    search: Search<'a>,
    point: Vector,
    solid: bool,
}

impl Walk<(Vector, bool)> for NearSearch<'_> {
    fn walk(&self, visit: &mut dyn FnMut(&Candidate, Scalar) -> Scalar) {
        self.search.scene().near(world_to_kernel(self.point), visit);
    }

    fn hit(&self, candidate: &Candidate, limit: Scalar) -> Option<Found<(Vector, bool)>> {
        if !self.search.passes(candidate) {
            return None;
        }
        if is_foreign(candidate.shape) {
            let (position, rotation) = candidate.components();
            let collider = self.search.component(candidate)?;
            let (point, is_inside) = collider.project_point(position, rotation, self.point, self.solid);
            let distance = (point - self.point).length();
            return (distance <= limit).then(|| Found::new(candidate, distance, (point, is_inside)));
        }
        let local = candidate.pose.inverse_transform(world_to_kernel(self.point));
        // Rounded up.
        let limit = to_f32(limit).next_up();
        let limit = if limit < f32::MAX { limit } else { f32::MAX };
        let found = project_point(candidate.shape, local, self.solid, limit)?;
        let is_given = found.is_inside && self.solid;
        let point =
            if is_given { self.point } else { world_from_kernel(candidate.pose.transform(found.point)) };
        Some(Found::new(candidate, found.distance as Scalar, (point, found.is_inside)))
    }
}

impl From<Found<Vector>> for RayHitData {
    fn from(found: Found<Vector>) -> Self {
        Self { entity: found.entity, distance: kernel::query::Hit::distance(&found), normal: found.data }
    }
}

impl From<Found<Touch>> for ShapeHitData {
    fn from(found: Found<Touch>) -> Self {
        let Touch { points: [point1, point2], normals: [normal1, normal2] } = found.data;
        let distance = kernel::query::Hit::distance(&found);
        Self { entity: found.entity, distance, point1, point2, normal1, normal2 }
    }
}

/// A direction in the public precision.
fn vector_of(direction: Dir) -> Vector {
    VectorF32::from(direction).adjust_precision()
}
