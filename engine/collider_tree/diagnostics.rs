//! How long the trees took.

use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;

/// Timers of the trees in the last step.
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct ColliderTreeDiagnostics {
    /// Keeping the trees good to search.
    pub optimize: Duration,
    /// Moving boxes in the trees, [`optimize`](Self::optimize) included.
    pub update: Duration,
}

pub(crate) fn reset_trees(mut diagnostics: ResMut<ColliderTreeDiagnostics>) {
    *diagnostics = ColliderTreeDiagnostics::default();
}
