//! Replaces `mesh` in builds without feature `collider-from-mesh`: no constructor needs a mesh.

use bevy_ecs::{entity::Entity, system::SystemParam};
use core::marker::PhantomData;

use super::{ColliderConstructor, made::Made};
use crate::collision::collider::Collider;

/// No meshes.
#[derive(SystemParam)]
pub(super) struct Meshes<'w, 's> {
    _none: PhantomData<(&'w (), &'s ())>,
}

impl Meshes<'_, '_> {
    /// Begins a round of constructors.
    pub(super) fn begin(&mut self) {}

    /// Whether an entity lacks the mesh that a constructor needs.
    pub(super) fn lacks(&self, _: Entity, _: &ColliderConstructor) -> bool {
        false
    }

    /// The collider of a constructor.
    pub(super) fn make(&mut self, _: Entity, constructor: &ColliderConstructor) -> Made {
        Collider::from_constructor(constructor, None).into()
    }
}
