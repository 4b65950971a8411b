//! The components that say which body or collider of the tables an entity is.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use kernel::table::NONE;

/// A body's number in the tables; `u32::MAX` while it takes no part in the simulation.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[component(clone_behavior = Ignore)]
#[reflect(Component, Debug, PartialEq)]
pub struct BodyId(pub(crate) u32);

/// A collider's number in the tables; `u32::MAX` while it takes no part in the simulation.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[component(clone_behavior = Ignore)]
#[reflect(Component, Debug, PartialEq)]
pub struct ColliderId(pub(crate) u32);

impl Default for BodyId {
    fn default() -> Self {
        Self(NONE)
    }
}

impl Default for ColliderId {
    fn default() -> Self {
        Self(NONE)
    }
}
