//! Settings for optimizing the collider trees.

use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

/// How the trees of colliders are optimized after colliders moved.
///
/// All of it runs on one thread so far: trees are always optimized in place, within the step.
#[derive(Resource, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Resource, Debug, Default, PartialEq)]
pub struct ColliderTreeOptimization {
    /// The mode. [`TreeOptimizationMode::Adaptive`] by default.
    pub optimization_mode: TreeOptimizationMode,
    /// Whether trees are optimized in place. True by default. False optimizes a copy and swaps it in: *not
    /// yet*.
    pub optimize_in_place: bool,
    /// Whether optimization may run in parallel with the rest of the step. True by default. *Not yet*.
    pub use_async_tasks: bool,
}

impl Default for ColliderTreeOptimization {
    fn default() -> Self {
        Self {
            optimization_mode: TreeOptimizationMode::default(),
            optimize_in_place: true,
            use_async_tasks: true,
        }
    }
}

/// How a tree is optimized, from the cheapest mode to the most thorough one.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Clone, Debug, Default, PartialEq)]
pub enum TreeOptimizationMode {
    /// Moved leaves are removed and inserted again at the best place.
    Reinsert,
    /// Moved leaves grow in place. When one leaf in 16 has grown, the subtrees above these leaves are
    /// rebuilt.
    PartialRebuild,
    /// Moved leaves grow in place. When one leaf in 16 has grown, the tree is rebuilt.
    FullRebuild,
    /// Moved leaves grow in place. When one leaf in 16 has grown, the boxes above these leaves are refitted.
    /// When the sum of all boxes has grown by a quarter, the tree is rebuilt, in part or in full by the share
    /// of moved leaves. At shares that call for reinsertion, this engine rebuilds in part, which costs about
    /// the same.
    Adaptive {
        /// Up to this share of moved leaves, the leaves are [reinserted](Self::Reinsert). 0.15 by default.
        reinsert_threshold: f32,
        /// Up to this share of moved leaves the tree is [rebuilt in part](Self::PartialRebuild), above it [in
        /// full](Self::FullRebuild). 0.45 by default.
        partial_rebuild_threshold: f32,
    },
}

impl Default for TreeOptimizationMode {
    fn default() -> Self {
        Self::Adaptive { reinsert_threshold: 0.15, partial_rebuild_threshold: 0.45 }
    }
}

impl TreeOptimizationMode {
    /// The mode for a tree in which the share `moved_ratio` (0 to 1) of leaves moved. Never
    /// [`Adaptive`](Self::Adaptive).
    pub fn resolve(&self, moved_ratio: f32) -> TreeOptimizationMode {
        match *self {
            Self::Adaptive { reinsert_threshold, .. } if moved_ratio <= reinsert_threshold => Self::Reinsert,
            Self::Adaptive { partial_rebuild_threshold, .. } if moved_ratio <= partial_rebuild_threshold => {
                Self::PartialRebuild
            }
            Self::Adaptive { .. } => Self::FullRebuild,
            mode => mode,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adaptive_resolves_by_the_share_that_moved() {
        let mode = TreeOptimizationMode::default();
        for (ratio, expected) in [
            (0.0, TreeOptimizationMode::Reinsert),
            (0.15, TreeOptimizationMode::Reinsert),
            (0.16, TreeOptimizationMode::PartialRebuild),
            (0.45, TreeOptimizationMode::PartialRebuild),
            (0.46, TreeOptimizationMode::FullRebuild),
            (1.0, TreeOptimizationMode::FullRebuild),
            (f32::NAN, TreeOptimizationMode::FullRebuild),
        ] {
            assert_eq!(mode.resolve(ratio), expected);
            assert_eq!(TreeOptimizationMode::Reinsert.resolve(ratio), TreeOptimizationMode::Reinsert);
        }
    }
}
