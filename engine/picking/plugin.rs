//! The plugin of picking, and its system.

use bevy_app::prelude::*;
use bevy_camera::Camera;
use bevy_ecs::prelude::*;
use bevy_picking::{
    PickingSystems,
    backend::{PointerHits, ray::RayMap},
};
use std::time::Instant;

use super::{
    PhysicsPickable, PhysicsPickingDiagnostics, PhysicsPickingFilter, PhysicsPickingSettings, PickingTargets,
    dim::hits_along,
};
use crate::{
    diagnostics::{Within, list},
    dynamics::tables::Colliders,
    spatial_query::{SpatialQuery, SpatialQueryFilter},
};

/// Lets pointers pick colliders, in `PreUpdate`. See [`picking`](crate::picking).
///
/// It does nothing in an app without Bevy's `PickingPlugin` or without physics.
#[derive(Clone, Default)]
pub struct PhysicsPickingPlugin;

impl Plugin for PhysicsPickingPlugin {
    fn build(&self, app: &mut App) {
        list::<PhysicsPickingDiagnostics>(app, Within::Nothing);
        app.init_resource::<PhysicsPickingSettings>().add_systems(
            PreUpdate,
            update_hits
                .in_set(PickingSystems::Backend)
                .run_if(resource_exists::<RayMap>.and_then(resource_exists::<Colliders>)),
        );
    }
}

/// Finds the colliders below each pointer of each camera, and sends them as [`PointerHits`].
pub fn update_hits(
    picking_cameras: Query<(&Camera, Option<&PhysicsPickingFilter>, Has<PhysicsPickable>)>,
    ray_map: Res<RayMap>,
    targets: PickingTargets,
    backend_settings: Res<PhysicsPickingSettings>,
    spatial_query: SpatialQuery,
    mut output_events: MessageWriter<PointerHits>,
    mut diagnostics: ResMut<PhysicsPickingDiagnostics>,
) {
    let start = Instant::now();
    let require_markers = backend_settings.require_markers;
    let everything = &SpatialQueryFilter::DEFAULT;
    for (id, ray) in ray_map.iter() {
        let Ok((camera, filter, marked)) = picking_cameras.get(id.camera) else {
            continue;
        };
        if require_markers && !marked {
            continue;
        }
        let filter = filter.map_or(everything, |filter| &filter.0);
        let picks = hits_along((id.camera, *ray), &backend_settings, &spatial_query, filter, &targets);
        if !picks.is_empty() {
            output_events.write(PointerHits::new(id.pointer, picks, camera.order as f32));
        }
    }
    diagnostics.update_hits = start.elapsed();
}
