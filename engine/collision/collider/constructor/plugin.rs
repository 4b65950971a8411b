//! The plugin that makes colliders from constructors.

use bevy_app::{App, Plugin, Update};
use bevy_ecs::prelude::IntoScheduleConfigs;

use super::{
    set::ConstructorSystems,
    systems::{are_any, construct},
};
use crate::schedule::PhysicsSystems;

/// Makes colliders from [`ColliderConstructor`](super::ColliderConstructor) and
/// [`ColliderConstructorHierarchy`](super::ColliderConstructorHierarchy), in `Update`, also while
/// physics is paused.
///
/// Part of `PhysicsPlugins`.
#[derive(Default)]
pub struct ColliderConstructorPlugin;

impl Plugin for ColliderConstructorPlugin {
    fn build(&self, app: &mut App) {
        // If physics runs in `Update`, the step of the same frame sees the colliders.
        let construct = construct.run_if(are_any).in_set(ConstructorSystems);
        app.add_systems(Update, construct.before(PhysicsSystems::First));
    }
}
