//! Components with the id of a body or collider in the tables.
//!
//! Only the drain assigns ids, by writing to an existing component. Ids are valid only in their own world, so
//! the components have no reflection and are not cloned. An id that an app inserts is ignored: the entity
//! gets its own id in the next step.

use bevy_ecs::{lifecycle::HookContext, prelude::*, world::DeferredWorld};
use kernel::table::NONE;

/// Id of a body in the tables. `u32::MAX` while the body is not in the simulation.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[component(clone_behavior = Ignore, on_insert = forget_body)]
pub struct BodyId(pub(crate) u32);

/// Id of a collider in the tables. `u32::MAX` while the collider is not in the simulation.
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
