//! Timers of the collider trees.

use crate::diagnostics::diagnostic_paths;
use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;

/// Timers of the trees in the last step.
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct ColliderTreeDiagnostics {
    /// Time for optimizing the trees.
    pub optimize: Duration,
    /// Time for updating boxes in the trees, including [`optimize`](Self::optimize).
    pub update: Duration,
}

diagnostic_paths! {
    ColliderTreeDiagnostics {
        timer OPTIMIZE: "avian/collider_tree/optimize" = optimize,
        timer UPDATE: "avian/collider_tree/update" = update,
    }
    reset reset_trees
}

pub(crate) fn reset_trees(mut diagnostics: ResMut<ColliderTreeDiagnostics>) {
    *diagnostics = ColliderTreeDiagnostics::default();
}
