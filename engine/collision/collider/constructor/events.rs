//! The events sent when constructors are done.

use bevy_ecs::{entity::Entity, event::EntityEvent};

/// Triggered on an entity after its [`ColliderConstructor`](super::ColliderConstructor) inserted
/// the collider.
///
/// The constructor is already removed.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn setup(mut commands: Commands) {
///     commands
///         .spawn(ColliderConstructor::Capsule { radius: 0.4, height: 1.0 })
///         .observe(|ready: On<ColliderConstructorReady>| println!("{} collides now", ready.entity));
/// }
/// ```
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct ColliderConstructorReady {
    /// The entity with the collider.
    pub entity: Entity,
}

/// Triggered on an entity when its [`ColliderConstructorHierarchy`](super::ColliderConstructorHierarchy) is
/// done: all colliders below it are inserted, including colliders from meshes that had to be loaded.
///
/// The events of the single colliders come first. The hierarchy component is already removed. A constructor
/// that failed, with a warning, does not delay the event. A constructor whose mesh was removed, or is not
/// being loaded, delays it until the constructor gets a mesh or is removed.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct ColliderConstructorHierarchyReady {
    /// The entity that had the hierarchy component.
    pub entity: Entity,
}
