//! Timers of casters.

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
