//! The place of constructors in `Update`.

use bevy_ecs::schedule::SystemSet;

/// The system that makes colliders.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ConstructorSystems;
