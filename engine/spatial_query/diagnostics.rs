//! Timers of casters.

use crate::diagnostics::diagnostic_paths;
use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;

/// Time for updating casters in their last run.
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct SpatialQueryDiagnostics {
    /// Time for all [`RayCaster`](super::RayCaster)s.
    pub update_ray_casters: Duration,
    /// Time for all `ShapeCaster`s.
    pub update_shape_casters: Duration,
}

diagnostic_paths! {
    SpatialQueryDiagnostics {
        timer UPDATE_RAY_CASTERS: "avian/spatial_query/update_ray_casters" = update_ray_casters,
        timer UPDATE_SHAPE_CASTERS: "avian/spatial_query/update_shape_casters" = update_shape_casters,
    }
    reset reset_casters
}

fn reset_casters(mut diagnostics: ResMut<SpatialQueryDiagnostics>) {
    *diagnostics = SpatialQueryDiagnostics::default();
}
