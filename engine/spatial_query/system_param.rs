//! [`SpatialQuery`], the system parameter.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::{
    query::{contains_point, overlaps},
    shape::Aabb,
};
use std::sync::Arc;

use super::{
    RayHitData, ShapeCastConfig, ShapeHitData, SpatialQueryFilter,
    recent::Recent,
    searches::{Search, is_foreign},
    traversal::{all, nearest, some},
    world::World,
};
use crate::{
    collision::collider::{Collider, ColliderAabb, overlaps_foreign},
    math::{Dir, RotationValue, Scalar, Vector, world_to_kernel},
    physics_transform::{Position, Rotation, world_pose},
};

/// A system parameter for ray casts, shape casts, nearest points and overlaps with all colliders.
///
/// Queries see the present components of colliders; see [`spatial_query`](crate::spatial_query). Results are
/// the same on every machine and for any number of threads. Hits are nearest first, and at the same distance
/// in the order in which colliders entered the simulation. Sensors are found, disabled colliders are not.
///
/// A query is read-only, so that many threads can share the parameter. A ray or cast whose origin is not
/// finite, whose direction has no length, or whose distance is negative or NaN hits nothing. Lengths are in
/// metres.
///
/// ```
/// # use avian::{math::*, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn is_on_ground(players: Query<(Entity, &Position), With<RigidBody>>, queries: SpatialQuery) {
///     for (player, position) in &players {
///         let filter = SpatialQueryFilter::from_excluded_entities([player]);
///         if let Some(hit) = queries.cast_ray(position.0, Dir::NEG_Y, 1.1, true, &filter) {
///             println!("{player} stands {} m above {}", hit.distance, hit.entity);
///         }
///     }
/// }
/// ```
#[derive(SystemParam)]
pub struct SpatialQuery<'w, 's> {
    world: World<'w, 's>,
}

/// The nearest point of a collider to a point.
#[derive(Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, PartialEq)]
pub struct PointProjection {
    /// The collider.
    pub entity: Entity,
    /// The nearest point of the collider, in the world, in metres.
    pub point: Vector,
    /// Whether the given point is inside the collider.
    pub is_inside: bool,
}

/// First-hit searches of the present colliders in one run of a system.
pub(super) struct FirstHits<'a> {
    queries: &'a SpatialQuery<'a, 'a>,
    recent: Arc<Recent>,
}

impl FirstHits<'_> {
    pub(super) fn of_ray(
        &self,
        origin: Vector,
        direction: Dir,
        max_distance: Scalar,
        solid: bool,
        filter: &SpatialQueryFilter,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Option<RayHitData> {
        let search = self.queries.search(&self.recent, filter).ray(origin, direction, max_distance, solid)?;
        nearest(&search, predicate).map(RayHitData::from)
    }

    pub(super) fn of_shape(
        &self,
        start: (&Collider, (Position, Rotation)),
        direction: Dir,
        config: &ShapeCastConfig,
        filter: &SpatialQueryFilter,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Option<ShapeHitData> {
        let search = self.queries.search(&self.recent, filter).shape(start, direction, config)?;
        nearest(&search, predicate).map(ShapeHitData::from)
    }

    pub(super) fn of_point(
        &self,
        point: Vector,
        solid: bool,
        filter: &SpatialQueryFilter,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Option<PointProjection> {
        let search = self.queries.search(&self.recent, filter).near(point, solid);
        let found = nearest(&search, predicate)?;
        let (point, is_inside) = found.data;
        Some(PointProjection { entity: found.entity, point, is_inside })
    }
}

/// The pose of a shape in a query.
pub(super) fn pose_of(position: Vector, rotation: RotationValue) -> (Position, Rotation) {
    (Position(position), Rotation::from(rotation))
}

pub(super) const EVERY: &dyn Fn(Entity) -> bool = &|_| true;

static EVERYTHING: &SpatialQueryFilter = &SpatialQueryFilter::DEFAULT;

impl SpatialQuery<'_, '_> {
    /// The first collider that a ray hits.
    ///
    /// If `solid`, a ray that starts inside a collider hits it at distance 0 with a zero normal. Otherwise it
    /// hits the boundary from within.
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Dir,
        max_distance: Scalar,
        solid: bool,
        filter: &SpatialQueryFilter,
    ) -> Option<RayHitData> {
        self.cast_ray_predicate(origin, direction, max_distance, solid, filter, EVERY)
    }

    /// The first collider that a ray hits, among the colliders for which the predicate is true.
    pub fn cast_ray_predicate(
        &self,
        origin: Vector,
        direction: Dir,
        max_distance: Scalar,
        solid: bool,
        filter: &SpatialQueryFilter,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Option<RayHitData> {
        self.first_hits().of_ray(origin, direction, max_distance, solid, filter, predicate)
    }

    /// All colliders that a ray hits, nearest first, at most `max_hits`.
    pub fn ray_hits(
        &self,
        origin: Vector,
        direction: Dir,
        max_distance: Scalar,
        max_hits: u32,
        solid: bool,
        filter: &SpatialQueryFilter,
    ) -> Vec<RayHitData> {
        let recent = self.world.recent();
        let search = self.search(&recent, filter).ray(origin, direction, max_distance, solid);
        let hits = search.map(|search| some(&search, max_hits, EVERY)).unwrap_or_default();
        hits.into_iter().map(RayHitData::from).collect()
    }

    /// Calls `callback` with all colliders that a ray hits, nearest first, until it returns `false`.
    pub fn ray_hits_callback(
        &self,
        origin: Vector,
        direction: Dir,
        max_distance: Scalar,
        solid: bool,
        filter: &SpatialQueryFilter,
        mut callback: impl FnMut(RayHitData) -> bool,
    ) {
        let recent = self.world.recent();
        let search = self.search(&recent, filter).ray(origin, direction, max_distance, solid);
        let hits = search.map(|search| all(&search, EVERY)).unwrap_or_default();
        _ = hits.into_iter().all(|hit| callback(hit.into()));
    }

    /// The first collider that a shape hits. The shape moves from `origin` along `direction` without
    /// rotation.
    ///
    /// A shape that touches a collider at the start hits it at distance 0; see [`ShapeCastConfig`].
    pub fn cast_shape(
        &self,
        shape: &Collider,
        origin: Vector,
        shape_rotation: RotationValue,
        direction: Dir,
        config: &ShapeCastConfig,
        filter: &SpatialQueryFilter,
    ) -> Option<ShapeHitData> {
        self.cast_shape_predicate(shape, origin, shape_rotation, direction, config, filter, EVERY)
    }

    /// The first collider that a shape hits, among the colliders for which the predicate is true.
    #[expect(clippy::too_many_arguments, reason = "as in Avian")]
    pub fn cast_shape_predicate(
        &self,
        shape: &Collider,
        origin: Vector,
        shape_rotation: RotationValue,
        direction: Dir,
        config: &ShapeCastConfig,
        filter: &SpatialQueryFilter,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Option<ShapeHitData> {
        let start = (shape, pose_of(origin, shape_rotation));
        self.first_hits().of_shape(start, direction, config, filter, predicate)
    }

    /// All colliders that a cast shape hits, nearest first, at most `max_hits`.
    #[expect(clippy::too_many_arguments, reason = "as in Avian")]
    pub fn shape_hits(
        &self,
        shape: &Collider,
        origin: Vector,
        shape_rotation: RotationValue,
        direction: Dir,
        max_hits: u32,
        config: &ShapeCastConfig,
        filter: &SpatialQueryFilter,
    ) -> Vec<ShapeHitData> {
        let start = (shape, pose_of(origin, shape_rotation));
        self.shape_hits_predicate(start, direction, max_hits, config, filter, EVERY)
    }

    /// Calls `callback` with all colliders that a cast shape hits, nearest first, until it returns `false`.
    #[expect(clippy::too_many_arguments, reason = "as in Avian")]
    pub fn shape_hits_callback(
        &self,
        shape: &Collider,
        origin: Vector,
        shape_rotation: RotationValue,
        direction: Dir,
        config: &ShapeCastConfig,
        filter: &SpatialQueryFilter,
        mut callback: impl FnMut(ShapeHitData) -> bool,
    ) {
        let hits = self.shape_hits(shape, origin, shape_rotation, direction, u32::MAX, config, filter);
        _ = hits.into_iter().all(&mut callback);
    }

    /// The collider nearest to a point, and the nearest point of that collider.
    ///
    /// If `solid`, a point inside a collider is its own projection. Otherwise it is projected onto the
    /// boundary.
    pub fn project_point(
        &self,
        point: Vector,
        solid: bool,
        filter: &SpatialQueryFilter,
    ) -> Option<PointProjection> {
        self.project_point_predicate(point, solid, filter, EVERY)
    }

    /// The collider nearest to a point, among the colliders for which the predicate is true.
    pub fn project_point_predicate(
        &self,
        point: Vector,
        solid: bool,
        filter: &SpatialQueryFilter,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Option<PointProjection> {
        self.first_hits().of_point(point, solid, filter, predicate)
    }

    /// All colliders that contain a point, in the order in which colliders entered the simulation.
    pub fn point_intersections(&self, point: Vector, filter: &SpatialQueryFilter) -> Vec<Entity> {
        let recent = self.world.recent();
        let search = self.search(&recent, filter);
        let at = world_to_kernel(point);
        let zero = Aabb::around([kernel::math::Vector::ZERO]);
        search.scene().touching(&zero.at(at), |candidate| {
            if !search.passes(candidate) {
                return false;
            }
            if is_foreign(candidate.shape) {
                let (position, rotation) = candidate.components();
                return search
                    .component(candidate)
                    .is_some_and(|collider| collider.contains_point(position, rotation, point));
            }
            contains_point(candidate.shape, candidate.pose.inverse_transform(at))
        })
    }

    /// Calls `callback` with all colliders that contain a point, until it returns `false`.
    pub fn point_intersections_callback(
        &self,
        point: Vector,
        filter: &SpatialQueryFilter,
        mut callback: impl FnMut(Entity) -> bool,
    ) {
        _ = self.point_intersections(point, filter).into_iter().all(&mut callback);
    }

    /// All colliders whose boxes touch a box, in the order in which colliders entered the simulation.
    pub fn aabb_intersections_with_aabb(&self, aabb: ColliderAabb) -> Vec<Entity> {
        let recent = self.world.recent();
        let search = self.search(&recent, EVERYTHING);
        let aabb = to_kernel_box(&aabb);
        search.scene().touching(&aabb, |candidate| candidate.shape.aabb(&candidate.pose).overlaps(&aabb))
    }

    /// Calls `callback` with all colliders whose boxes touch a box, until it returns `false`.
    pub fn aabb_intersections_with_aabb_callback(
        &self,
        aabb: ColliderAabb,
        mut callback: impl FnMut(Entity) -> bool,
    ) {
        _ = self.aabb_intersections_with_aabb(aabb).into_iter().all(&mut callback);
    }

    /// All colliders that touch or overlap a shape, in the order in which colliders entered the simulation.
    pub fn shape_intersections(
        &self,
        shape: &Collider,
        shape_position: Vector,
        shape_rotation: RotationValue,
        filter: &SpatialQueryFilter,
    ) -> Vec<Entity> {
        let recent = self.world.recent();
        let search = self.search(&recent, filter);
        let pose = pose_of(shape_position, shape_rotation);
        let at = world_pose(&pose.0, &pose.1);
        if !(at.position.is_finite_world() && at.rotation.is_finite()) {
            return Vec::new();
        }
        let native = shape.native();
        search.scene().touching(&native.aabb(&at), |candidate| {
            if !search.passes(candidate) {
                return false;
            }
            if is_foreign(candidate.shape) || is_foreign(native) {
                let collider = search.component(candidate);
                return collider
                    .is_some_and(|c| overlaps_foreign((c, candidate.components()), (shape, pose)));
            }
            overlaps(candidate.shape, native, &candidate.pose.relative(&at))
        })
    }

    /// Calls `callback` with all colliders that touch or overlap a shape, until it returns `false`.
    pub fn shape_intersections_callback(
        &self,
        shape: &Collider,
        shape_position: Vector,
        shape_rotation: RotationValue,
        filter: &SpatialQueryFilter,
        mut callback: impl FnMut(Entity) -> bool,
    ) {
        let found = self.shape_intersections(shape, shape_position, shape_rotation, filter);
        _ = found.into_iter().all(&mut callback);
    }

    /// As [`ray_hits`](Self::ray_hits), for the colliders for which the predicate is true.
    #[expect(clippy::too_many_arguments, reason = "as the public functions")]
    pub(super) fn ray_hits_predicate(
        &self,
        origin: Vector,
        direction: Dir,
        max_distance: Scalar,
        max_hits: u32,
        solid: bool,
        filter: &SpatialQueryFilter,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Vec<RayHitData> {
        let recent = self.world.recent();
        let search = self.search(&recent, filter).ray(origin, direction, max_distance, solid);
        let hits = search.map(|search| some(&search, max_hits, predicate)).unwrap_or_default();
        hits.into_iter().map(RayHitData::from).collect()
    }

    /// As [`shape_hits`](Self::shape_hits), for the colliders for which the predicate is true.
    pub(super) fn shape_hits_predicate(
        &self,
        start: (&Collider, (Position, Rotation)),
        direction: Dir,
        max_hits: u32,
        config: &ShapeCastConfig,
        filter: &SpatialQueryFilter,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Vec<ShapeHitData> {
        let recent = self.world.recent();
        let search = self.search(&recent, filter).shape(start, direction, config);
        let hits = search.map(|search| some(&search, max_hits, predicate)).unwrap_or_default();
        hits.into_iter().map(ShapeHitData::from).collect()
    }

    /// Searches for first hits of all colliders.
    pub(super) fn first_hits(&self) -> FirstHits<'_> {
        FirstHits { queries: self, recent: self.world.recent() }
    }

    /// The body of a collider.
    pub(super) fn body_of(&self, collider: Entity) -> Option<Entity> {
        self.world.body_of(collider)
    }

    /// The colliders that changed since the last step.
    pub(super) fn recent(&self) -> Arc<Recent> {
        self.world.recent()
    }

    pub(super) fn search<'a>(
        &'a self,
        recent: &'a Arc<Recent>,
        filter: &'a SpatialQueryFilter,
    ) -> Search<'a> {
        Search::new(&self.world, recent, filter)
    }
}

/// A box in the kernel's precision, rounded outward.
fn to_kernel_box(aabb: &ColliderAabb) -> Aabb {
    let zero = Aabb::around([kernel::math::Vector::ZERO]);
    let (low, high) = (zero.at(world_to_kernel(aabb.min)), zero.at(world_to_kernel(aabb.max)));
    Aabb::new(low.min, high.max)
}
