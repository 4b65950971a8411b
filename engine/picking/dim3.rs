//! Picking in space. `dim2.rs` exports the same names.

use bevy_ecs::prelude::*;
use bevy_math::Ray3d;
use bevy_picking::backend::HitData;
use bevy_reflect::prelude::*;

use super::PickingTargets;
use crate::{
    math::{AdjustPrecision, AsF32, Scalar, to_f32},
    spatial_query::{SpatialQuery, SpatialQueryFilter},
};

/// Settings of [`PhysicsPickingPlugin`](super::PhysicsPickingPlugin).
#[derive(Resource, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(type_path = false, Resource, Debug, Default, PartialEq)]
pub struct PhysicsPickingSettings {
    /// Whether only cameras and entities with [`PhysicsPickable`](super::PhysicsPickable) take part.
    /// `false` by default.
    pub require_markers: bool,
}

crate::type_path::type_path!(PhysicsPickingSettings, "picking");

/// The hits of a pointer's ray: colliders up to the first that hides the others.
pub(super) fn hits_along(
    (camera, ray): (Entity, Ray3d),
    settings: &PhysicsPickingSettings,
    queries: &SpatialQuery,
    filter: &SpatialQueryFilter,
    targets: &PickingTargets,
) -> Vec<(Entity, HitData)> {
    let mut hits = Vec::new();
    let origin = ray.origin.adjust_precision();
    queries.ray_hits_callback(origin, ray.direction, Scalar::MAX, false, filter, |hit| {
        if !targets.is_met(hit.entity, settings.require_markers) {
            return true;
        }
        let depth = to_f32(hit.distance);
        let data = HitData::new(camera, depth, Some(ray.get_point(depth)), Some(hit.normal.f32()));
        hits.push((hit.entity, data));
        !is_opaque(targets, hit.entity)
    });
    hits
}

/// Whether an entity hides the entities behind it. In 2D Bevy decides that, by depth.
fn is_opaque(targets: &PickingTargets, entity: Entity) -> bool {
    !targets.states.get(entity).is_ok_and(|(pickable, ..)| pickable.is_some_and(|p| !p.should_block_lower))
}
