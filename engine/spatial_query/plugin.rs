//! The plugin of spatial queries.

use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::{intern::Interned, prelude::*, schedule::ScheduleLabel};
use bevy_transform::TransformSystems;

use super::{SpatialQueryDiagnostics, SpatialQuerySystems};
use crate::{
    diagnostics::{Within, list},
    schedule::PhysicsSystems,
    step,
};

/// Updates [`RayCaster`](super::RayCaster)s and `ShapeCaster`s once per run of a schedule, also while physics
/// is paused. The parameter `SpatialQuery` works without it.
pub struct SpatialQueryPlugin {
    schedule: Interned<dyn ScheduleLabel>,
}

impl SpatialQueryPlugin {
    /// Updates casters in a schedule. The default is [`FixedPostUpdate`].
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern() }
    }
}

impl Default for SpatialQueryPlugin {
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl Plugin for SpatialQueryPlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        list::<SpatialQueryDiagnostics>(app, Within::Nothing);
        app.configure_sets(
            self.schedule,
            SpatialQuerySystems.after(PhysicsSystems::Last).after(TransformSystems::Propagate),
        );
        #[cfg(feature = "default-collider")]
        step::add_systems(
            app,
            self.schedule,
            (super::update::update_ray_casters, super::update::update_shape_casters)
                .chain()
                .in_set(SpatialQuerySystems),
        );
    }
}
