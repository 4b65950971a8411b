//! Replaces `scene` in builds without feature `bevy_scene`: entities that spawn a scene cannot be recognised.

use bevy_ecs::{entity::Entity, system::SystemParam};
use core::marker::PhantomData;

/// No scenes.
#[derive(SystemParam)]
pub(super) struct Scenes<'w, 's> {
    _none: PhantomData<(&'w (), &'s ())>,
}

impl Scenes<'_, '_> {
    /// Whether scenes are known, and waited for.
    pub(super) const ARE_KNOWN: bool = false;

    /// Whether an entity waits for the scene it spawns.
    pub(super) fn is_awaited(&self, _: Entity) -> bool {
        false
    }
}
