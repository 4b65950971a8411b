//! The systems that update casters.

use bevy_ecs::prelude::*;
use bevy_platform::time::Instant;

use super::{
    RayCaster, RayHits, ShapeCaster, ShapeHits, SpatialQuery, SpatialQueryDiagnostics, frame::Frames,
};
use crate::physics_transform::Rotation;

/// Casts the rays of all casters.
pub(super) fn update_ray_casters(
    mut casters: Query<(Entity, &mut RayCaster, &mut RayHits)>,
    frames: Frames,
    queries: SpatialQuery,
    mut diagnostics: ResMut<SpatialQueryDiagnostics>,
) {
    let start = Instant::now();
    for (entity, mut caster, mut hits) in &mut casters {
        if !caster.enabled {
            if !hits.is_empty() {
                hits.clear();
            }
            continue;
        }
        // Only computed fields change, so this is no change by the app.
        caster.bypass_change_detection().place(&frames.of(entity));
        let own = Own::of(entity, caster.ignore_self, &frames);
        hits.0 = queries.ray_hits_predicate(
            caster.global_origin(),
            caster.global_direction(),
            caster.max_distance,
            caster.max_hits,
            caster.solid,
            &caster.query_filter,
            &|collider| !own.has(collider, &queries),
        );
    }
    diagnostics.update_ray_casters = start.elapsed();
}

/// Casts the shapes of all casters.
pub(super) fn update_shape_casters(
    mut casters: Query<(Entity, &mut ShapeCaster, &mut ShapeHits)>,
    frames: Frames,
    queries: SpatialQuery,
    mut diagnostics: ResMut<SpatialQueryDiagnostics>,
) {
    let start = Instant::now();
    for (entity, mut caster, mut hits) in &mut casters {
        if !caster.enabled {
            if !hits.is_empty() {
                hits.clear();
            }
            continue;
        }
        caster.bypass_change_detection().place(&frames.of(entity));
        let own = Own::of(entity, caster.ignore_self, &frames);
        let pose = (caster.global_origin().into(), Rotation::from(caster.global_shape_rotation()));
        hits.0 = queries.shape_hits_predicate(
            (&caster.shape, pose),
            caster.global_direction(),
            caster.max_hits,
            &caster.config(),
            &caster.query_filter,
            &|collider| !own.has(collider, &queries),
        );
    }
    diagnostics.update_shape_casters = start.elapsed();
}

/// The colliders that a caster ignores as its own.
struct Own {
    entity: Option<Entity>,
    body: Option<Entity>,
}

impl Own {
    fn of(entity: Entity, ignored: bool, frames: &Frames) -> Self {
        if !ignored {
            return Self { entity: None, body: None };
        }
        Self { entity: Some(entity), body: frames.body_of(entity) }
    }

    fn has(&self, collider: Entity, queries: &SpatialQuery) -> bool {
        self.entity == Some(collider) || self.body.is_some() && queries.body_of(collider) == self.body
    }
}
