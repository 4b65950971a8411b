//! Timers and counters of collision detection.

use crate::diagnostics::diagnostic_paths;
use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;

/// Timers and counters of collision detection in the last step.
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct CollisionDiagnostics {
    /// Finding pairs.
    pub broad_phase: Duration,
    /// Computing contacts and applying their effects.
    pub narrow_phase: Duration,
    /// Number of contacts, touching or near, of awake and sleeping bodies.
    pub contact_count: u32,
}

diagnostic_paths! {
    CollisionDiagnostics {
        timer BROAD_PHASE: "avian/collision/broad_phase" = broad_phase,
        timer NARROW_PHASE: "avian/collision/update_contacts" = narrow_phase,
        counter CONTACT_COUNT: "avian/collision/contact_count" = contact_count,
    }
    reset reset_collision
}

pub(crate) fn reset_collision(mut diagnostics: ResMut<CollisionDiagnostics>) {
    *diagnostics = CollisionDiagnostics { contact_count: diagnostics.contact_count, ..Default::default() };
}
