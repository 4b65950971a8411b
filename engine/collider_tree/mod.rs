//! The bounding volume hierarchies over all colliders, which the broad phase and spatial queries search.

pub(crate) mod diagnostics;
pub(crate) mod optimization;
mod plugin;
pub(crate) mod proxies;

pub use diagnostics::ColliderTreeDiagnostics;
pub use optimization::{ColliderTreeOptimization, TreeOptimizationMode};
pub use plugin::ColliderTreePlugin;

use bevy_ecs::prelude::*;

/// System sets that update the trees, in this order, in
/// [`PhysicsSchedule`](crate::schedule::PhysicsSchedule).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ColliderTreeSystems {
    /// Boxes follow their colliders, before pairs are searched.
    UpdateAabbs,
    /// Optimization of the trees starts, after pairs were found.
    BeginOptimize,
    /// Optimization of the trees is done, in
    /// [`PhysicsStepSystems::Finalize`](crate::schedule::PhysicsStepSystems::Finalize).
    EndOptimize,
}
