//! The components that say which body or collider of the tables an entity is.
//!
//! Only the drain gives ids out, by writing to a component that is there. They mean nothing outside of the world
//! and the tables they belong to, so they do not reflect, are not cloned, and one that is inserted, by whatever
//! way, counts for nothing: the entity gets its own in the next step.

use bevy_ecs::{lifecycle::HookContext, prelude::*, world::DeferredWorld};
use kernel::table::NONE;

/// A body's number in the tables; `u32::MAX` while it takes no part in the simulation.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[component(clone_behavior = Ignore, on_insert = forget_body)]
pub struct BodyId(pub(crate) u32);

/// A collider's number in the tables; `u32::MAX` while it takes no part in the simulation.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[component(clone_behavior = Ignore, on_insert = forget_collider)]
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

fn forget_body(mut world: DeferredWorld, context: HookContext) {
    if let Some(mut id) = world.get_mut::<BodyId>(context.entity) {
        id.bypass_change_detection().0 = NONE;
    }
}

fn forget_collider(mut world: DeferredWorld, context: HookContext) {
    if let Some(mut id) = world.get_mut::<ColliderId>(context.entity) {
        id.bypass_change_detection().0 = NONE;
    }
}
