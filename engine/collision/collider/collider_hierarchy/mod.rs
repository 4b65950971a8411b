//! Which collider belongs to which body: [`ColliderOf`] and [`RigidBodyColliders`], derived from
//! the hierarchy.

mod plugin;

pub use plugin::ColliderHierarchyPlugin;
pub(super) use plugin::{AttachesColliders, PlacesColliders, attach_now};

use bevy_ecs::{
    entity::{ComponentCloneCtx, SourceComponent},
    lifecycle::HookContext,
    prelude::*,
    reflect::ReflectComponent,
    relationship::{Relationship, RelationshipHookMode, RelationshipTarget, clone_relationship_target},
    world::DeferredWorld,
};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::collider_transform::ColliderTransform;
use crate::physics_transform::tree::FollowsBody;

/// On a collider: its body. This is the nearest entity with a
/// [`RigidBody`](crate::dynamics::rigid_body::RigidBody), among the collider's own entity and its ancestors.
///
/// The engine inserts, replaces and removes the component at the end of the command that changed the
/// hierarchy. Colliders without a body do not have it.
///
/// An app may insert it with any body; the engine then keeps it until the app removes it. The collider's pose
/// on the body is its [`ColliderTransform`]. If that has its default value, the collider keeps the world pose
/// of its own `Transform`. If both are default, the collider is at the body's origin.
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
    /// The body; the collider's own entity if that entity is a body.
    #[entities]
    pub body: Entity,
}

impl FromWorld for ColliderOf {
    fn from_world(_: &mut World) -> Self {
        Self { body: Entity::PLACEHOLDER }
    }
}

impl ColliderOf {
    /// Whether the app, not the hierarchy, attached a collider. The link of a body to itself always belongs
    /// to the hierarchy.
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

    /// Adds the collider to the body's list, as Bevy's own hook does. Unlike Bevy's hook it reports no error
    /// if an observer has despawned one of the entities, and does not add a body to its own list twice.
    fn on_insert(mut world: DeferredWorld, context: HookContext) {
        // The clone of a body has no list. The links of its cloned colliders create one.
        if matches!(context.relationship_hook_mode, RelationshipHookMode::Skip) {
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

/// On a body: its colliders, including the body's own entity if that has a collider. Despawning the body
/// despawns all of them.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Component, Debug, Default, PartialEq)]
#[component(
    clone_behavior = Custom(clone_list),
    on_discard = <RigidBodyColliders as RelationshipTarget>::on_discard,
    on_despawn = <RigidBodyColliders as RelationshipTarget>::on_despawn,
)]
pub struct RigidBodyColliders(#[entities] Vec<Entity>);

impl RelationshipTarget for RigidBodyColliders {
    const LINKED_SPAWN: bool = true;

    type Relationship = ColliderOf;
    type Collection = Vec<Entity>;

    fn collection(&self) -> &Vec<Entity> {
        &self.0
    }

    fn collection_mut_risky(&mut self) -> &mut Vec<Entity> {
        &mut self.0
    }

    fn from_collection_risky(collection: Vec<Entity>) -> Self {
        Self(collection)
    }
}

/// Does not clone the list: the links of cloned colliders create it. Colliders below a body are cloned with
/// its children, if children are cloned. In that case this function clones the colliders that the app
/// attached and that are not below the body.
fn clone_list(source: &SourceComponent, context: &mut ComponentCloneCtx) {
    let Some(list) = source.read::<RigidBodyColliders>() else { return };
    if context.moving() {
        let mut moved = RigidBodyColliders::default();
        clone_relationship_target(list, &mut moved, context);
        return context.write_target_component(moved);
    }
    if context.linked_cloning() {
        let (colliders, original, clone) = (list.0.clone(), context.source(), context.target());
        context.queue_deferred(move |world: &mut World, _| {
            let is_below = |collider: Entity, world: &World| {
                let above = |at: &Entity| world.get::<ChildOf>(*at).map(ChildOf::parent);
                core::iter::successors(Some(collider), above).any(|at| at == original)
            };
            for collider in colliders {
                if !is_below(collider, world)
                    && let Ok(mut entity) = world.get_entity_mut(collider)
                {
                    let copy = entity.clone_and_spawn_with_opt_out(|cloner| _ = cloner.linked_cloning(true));
                    world.entity_mut(copy).insert(ColliderOf { body: clone });
                }
            }
        });
    }
}

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
