//! How long collision detection took, and how much it found.

use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;

/// Timers and counters of collision detection in the last step.
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct CollisionDiagnostics {
    /// Finding pairs.
    pub broad_phase: Duration,
    /// Computing contacts, and letting them take effect.
    pub narrow_phase: Duration,
    /// Contacts between awake and sleeping bodies alike, touching or near.
    pub contact_count: u32,
}

pub(crate) fn reset_collision(mut diagnostics: ResMut<CollisionDiagnostics>) {
    *diagnostics = CollisionDiagnostics { contact_count: diagnostics.contact_count, ..Default::default() };
}
