//! The input of the narrow phase.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_time::Time;
use kernel::{
    contact::{ManifoldSource, NarrowPhaseInput},
    table::{BodyTable, ColliderTable},
};

use super::NarrowPhaseConfig;
use crate::{
    dynamics::solver::{
        RowWidth, WorkerCount,
        config::{LINEAR_SLOP, PhysicsLengthUnit},
    },
    math::to_f32,
    schedule::Physics,
};

/// Prediction distance of contacts at rest, times the length unit. With a smaller value stacks lose contact
/// points. With a larger one contacts that never touch are computed.
const SPECULATIVE: f32 = (4.0 * LINEAR_SLOP) as f32;
/// Maximum relative motion of two surfaces for which a manifold is recycled, times the length unit. With a
/// larger value contacts lag behind rolling bodies. With a smaller one stacks jitter and steps take longer.
const RECYCLE: f32 = (10.0 * LINEAR_SLOP) as f32;

/// Settings of the narrow phase.
#[derive(SystemParam)]
pub(crate) struct Settings<'w> {
    config: Res<'w, NarrowPhaseConfig>,
    unit: Res<'w, PhysicsLengthUnit>,
    time: Res<'w, Time<Physics>>,
    pub(crate) workers: Res<'w, WorkerCount>,
    width: Res<'w, RowWidth>,
}

impl Settings<'_> {
    /// The input of the narrow phase.
    pub(crate) fn input<'a>(
        &self,
        bodies: &'a BodyTable,
        colliders: &'a ColliderTable,
        source: &'a dyn ManifoldSource,
    ) -> NarrowPhaseInput<'a> {
        let unit = self.unit.metres();
        NarrowPhaseInput {
            bodies,
            colliders,
            source,
            dt: self.time.delta_secs(),
            tolerance: to_f32(self.config.contact_tolerance).max(0.0) * unit,
            speculative: SPECULATIVE * unit,
            recycle_distance: RECYCLE * unit,
            match_points: self.config.match_contacts,
            narrow: *self.width == RowWidth::Four,
        }
    }
}
