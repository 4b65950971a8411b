//! How long the trees took.

use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;

/// Timers of the trees in the last step.
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct ColliderTreeDiagnostics {
    /// Improving the trees. Zero until trees are optimized beside the step: within it, that is part of
    /// [`update`](Self::update).
    pub optimize: Duration,
    /// Moving boxes, and keeping the trees good to search.
    pub update: Duration,
}

pub(crate) fn reset_trees(mut diagnostics: ResMut<ColliderTreeDiagnostics>) {
    *diagnostics = ColliderTreeDiagnostics::default();
}
