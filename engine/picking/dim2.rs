//! Picking in the plane. `dim3.rs` exports the same names.

use bevy_ecs::prelude::*;
use bevy_math::Ray3d;
use bevy_picking::backend::HitData;
use bevy_reflect::prelude::*;

use super::PickingTargets;
use crate::{
    math::AdjustPrecision,
    spatial_query::{SpatialQuery, SpatialQueryFilter},
};

/// Settings of [`PhysicsPickingPlugin`](super::PhysicsPickingPlugin).
#[derive(Resource, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(type_path = false, Resource, Debug, Default, PartialEq)]
pub struct PhysicsPickingSettings {
    /// Whether only cameras and entities with [`PhysicsPickable`](super::PhysicsPickable) take part.
    /// `false` by default.
    pub require_markers: bool,
    /// The z of the plane in which pointers hit colliders, in world units. 0 by default. It matters if the
    /// camera is in perspective or rotated.
    pub z_plane: f32,
}

crate::type_path::type_path!(PhysicsPickingSettings, "picking");

/// The hits of a pointer's ray: all colliders at the point where it crosses the plane.
pub(super) fn hits_along(
    (camera, ray): (Entity, Ray3d),
    settings: &PhysicsPickingSettings,
    queries: &SpatialQuery,
    filter: &SpatialQueryFilter,
    targets: &PickingTargets,
) -> Vec<(Entity, HitData)> {
    let depth_of = |z: f32| (z - ray.origin.z) / ray.direction.z;
    let depth = depth_of(settings.z_plane);
    let point = ray.get_point(depth);
    // There are no hits if the ray runs along the plane or away from it.
    if !(depth >= 0.0 && point.is_finite()) {
        return Vec::new();
    }
    let mut hits = Vec::new();
    queries.point_intersections_callback(point.truncate().adjust_precision(), filter, |entity| {
        let depth = height(targets, entity).map_or(depth, depth_of);
        // Colliders behind the camera are not visible.
        if depth >= 0.0 && targets.is_met(entity, settings.require_markers) {
            hits.push((entity, HitData::new(camera, depth, Some(point), None)));
        }
        true
    });
    hits
}

/// The z of an entity in the world.
fn height(targets: &PickingTargets, entity: Entity) -> Option<f32> {
    targets.states.get(entity).ok()?.2.map(|transform| transform.translation().z)
}
