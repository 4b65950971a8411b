//! Which collider belongs to which body: [`ColliderOf`] and [`RigidBodyColliders`], derived from the hierarchy.

mod plugin;

pub use plugin::ColliderHierarchyPlugin;
pub(super) use plugin::{AttachesColliders, PlacesColliders, attach_now};

use bevy_ecs::{
    lifecycle::HookContext,
    prelude::*,
    reflect::ReflectComponent,
    relationship::{Relationship, RelationshipHookMode},
    world::DeferredWorld,
};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::collider_transform::ColliderTransform;
use crate::physics_transform::tree::FollowsBody;

/// On a collider: its body, the nearest of the entity itself and its ancestors with a
/// [`RigidBody`](crate::dynamics::rigid_body::RigidBody).
///
/// The engine inserts, replaces and removes it at the end of the command that changed the hierarchy. Colliders without
/// a body have none.
///
/// An app may insert it with any body; the engine then keeps it until the app removes it. The collider's pose on the
/// body is its [`ColliderTransform`]. If that has its default value, the collider stays where its own `Transform` puts
/// it in the world. If both are default, it is at the body's origin.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn arm(body: Entity, mut commands: Commands) {
///     commands.spawn((Collider::capsule(0.1, 0.5), ColliderOf { body }));
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Component, Debug, PartialEq, FromWorld)]
#[component(
    immutable,
    on_insert = <ColliderOf as Relationship>::on_insert,
    on_discard = <ColliderOf as Relationship>::on_discard,
)]
#[require(ColliderTransform)]
pub struct ColliderOf {
    /// The body; the collider's own entity if that is a body.
    #[entities]
    pub body: Entity,
}

impl FromWorld for ColliderOf {
    fn from_world(_: &mut World) -> Self {
        Self { body: Entity::PLACEHOLDER }
    }
}

impl ColliderOf {
    /// Whether the app, not the hierarchy, attached a collider. The link of a body to itself always belongs to the
    /// hierarchy.
    pub(super) fn is_explicit(&self, collider: Entity, follows: Option<&FollowsBody>) -> bool {
        self.body != collider && follows.and_then(|follows| follows.above) != Some(self.body)
    }
}

impl Relationship for ColliderOf {
    type RelationshipTarget = RigidBodyColliders;
    const ALLOW_SELF_REFERENTIAL: bool = true;

    fn get(&self) -> Entity {
        self.body
    }

    fn from(body: Entity) -> Self {
        Self { body }
    }

    fn set_risky(&mut self, body: Entity) {
        self.body = body;
    }

    /// Adds the collider to the body's list, as Bevy's own hook does. It reports no error if an observer has despawned
    /// one of them, and does not add a body to its own list twice.
    fn on_insert(mut world: DeferredWorld, context: HookContext) {
        if !matches!(context.relationship_hook_mode, RelationshipHookMode::Run) {
            return;
        }
        let collider = context.entity;
        let lists_itself = |list: &RigidBodyColliders| list.0.contains(&collider);
        let is_body = world.get::<Self>(collider).is_some_and(|of| of.body == collider);
        if is_body && world.get::<RigidBodyColliders>(collider).is_some_and(lists_itself) {
            return;
        }
        world.commands().queue(move |world: &mut World| list_collider(world, collider));
    }
}

fn list_collider(world: &mut World, collider: Entity) {
    let Some(&ColliderOf { body }) = world.get::<ColliderOf>(collider) else { return };
    let Ok(mut entity) = world.get_entity_mut(body) else {
        world.entity_mut(collider).remove::<(ColliderOf, FollowsBody)>();
        return;
    };
    match entity.get_mut::<RigidBodyColliders>() {
        Some(mut colliders) => colliders.0.push(collider),
        None => {
            entity.insert(RigidBodyColliders(vec![collider]));
        }
    }
}

/// On a body: its colliders, including its own entity if that has a collider. Despawning the body despawns them.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Component, Debug, Default, PartialEq)]
#[relationship_target(relationship = ColliderOf, linked_spawn)]
pub struct RigidBodyColliders(Vec<Entity>);

impl<'a> IntoIterator for &'a RigidBodyColliders {
    type Item = <Self::IntoIter as Iterator>::Item;
    type IntoIter = core::iter::Copied<core::slice::Iter<'a, Entity>>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter().copied()
    }
}

impl core::ops::Deref for RigidBodyColliders {
    type Target = [Entity];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

/// Marks a body with colliders on other entities.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct CompoundBody;
