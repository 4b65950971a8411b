//! The plugin that makes colliders from constructors.

use bevy_app::{App, Plugin, Update};
use bevy_ecs::prelude::IntoScheduleConfigs;

use super::{set::ConstructorSystems, systems::construct};
use crate::schedule::PhysicsSystems;

/// Makes colliders from [`ColliderConstructor`](super::ColliderConstructor) and
/// [`ColliderConstructorHierarchy`](super::ColliderConstructorHierarchy), in `Update`, also while physics is paused.
///
/// Part of `PhysicsPlugins`.
#[derive(Default)]
pub struct ColliderConstructorPlugin;

impl Plugin for ColliderConstructorPlugin {
    fn build(&self, app: &mut App) {
        // If physics runs in `Update`, the step of the same frame has the colliders.
        app.add_systems(Update, construct.in_set(ConstructorSystems).before(PhysicsSystems::First));
    }
}
