//! Which collider belongs to which body: [`ColliderOf`] and [`RigidBodyColliders`], kept from the hierarchy.

use bevy_app::{App, Plugin};
use bevy_ecs::{
    entity::EntityHashSet,
    entity_disabling::Disabled,
    lifecycle::HookContext,
    prelude::*,
    query::Allow,
    reflect::ReflectComponent,
    relationship::{Relationship, RelationshipHookMode},
    world::DeferredWorld,
};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};

use super::{ColliderMarker, collider_transform::ColliderTransform};
use crate::{
    dynamics::rigid_body::RigidBody,
    physics_transform::tree::{FollowsBody, HierarchyQueue, Parents, TransformTree, TreeChanges, enqueue},
};

/// On a collider: the body it belongs to, which is the nearest of the entity itself and its ancestors that
/// has a [`RigidBody`].
///
/// The engine inserts, replaces and removes it at the start of a step. A collider that is detached from its
/// parent loses it at once, so that it outlives the body. Colliders without a body have none.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Component, Debug, PartialEq, FromWorld)]
#[component(
    immutable,
    on_insert = <ColliderOf as Relationship>::on_insert,
    on_discard = <ColliderOf as Relationship>::on_discard,
)]
#[require(ColliderTransform)]
pub struct ColliderOf {
    /// The body; the collider's own entity if that is one.
    #[entities]
    pub body: Entity,
}

impl FromWorld for ColliderOf {
    fn from_world(_: &mut World) -> Self {
        Self { body: Entity::PLACEHOLDER }
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

    /// Lists the collider on its body, as Bevy's own hook does, but without an error where an observer
    /// despawns either of them before the list is made.
    fn on_insert(mut world: DeferredWorld, context: HookContext) {
        if !matches!(context.relationship_hook_mode, RelationshipHookMode::Run) {
            return;
        }
        let collider = context.entity;
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

/// On a body: the colliders that belong to it, the body's own entity among them if it has a collider.
/// Despawning the body despawns them.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
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

/// On a body that has colliders on other entities than its own.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct CompoundBody;

/// Keeps [`ColliderOf`] and [`RigidBodyColliders`] as the hierarchy says. The links are made by a system in
/// the schedule of [`ColliderTransformPlugin`](super::collider_transform::ColliderTransformPlugin).
pub struct ColliderHierarchyPlugin;

/// Present where colliders are to be attached.
#[derive(Resource)]
pub(crate) struct AttachesColliders;

impl Plugin for ColliderHierarchyPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<HierarchyQueue>()
            .init_resource::<TransformTree>()
            .insert_resource(AttachesColliders)
            .register_type::<(ColliderOf, RigidBodyColliders)>()
            .add_observer(enqueue::<Add, (RigidBody, ColliderMarker)>)
            .add_observer(enqueue::<Remove, (RigidBody, ColliderMarker)>)
            .add_observer(detach_at_once);
    }
}

/// Unlinks the colliders at and below an entity that leaves its parent, up to the next body. Should the old
/// body be despawned before the next step, they must not go with it.
fn detach_at_once(
    left: On<Discard, ChildOf>,
    tree: Res<TransformTree>,
    bodies: Query<(), (With<RigidBody>, Allow<Disabled>)>,
    following: Query<(), (With<FollowsBody>, Allow<Disabled>)>,
    mut commands: Commands,
) {
    let mut stack = vec![left.event_target()];
    while let Some(entity) = stack.pop() {
        if bodies.contains(entity) {
            continue;
        }
        if following.contains(entity) {
            commands.entity(entity).try_remove::<(ColliderOf, FollowsBody)>();
        }
        stack.extend_from_slice(tree.children(entity));
    }
}

/// Attaches the colliders at and below every entity of this step's queue to the nearest body.
pub(crate) fn attach_colliders(
    changes: Res<TreeChanges>,
    tree: Res<TransformTree>,
    parents: Parents,
    bodies: Query<(), (With<RigidBody>, Allow<Disabled>)>,
    colliders: Query<(Has<ColliderMarker>, Option<&ColliderOf>), Allow<Disabled>>,
    mut commands: Commands,
    mut seen: Local<EntityHashSet>,
) {
    seen.clear();
    let mut links: Vec<(Entity, Option<Entity>)> = Vec::new();
    for &entity in &changes.queued {
        let above = |at: &Entity| parents.get(*at).ok().map(ChildOf::parent);
        let body = core::iter::successors(above(&entity), above).find(|&ancestor| bodies.contains(ancestor));
        let mut stack = vec![(entity, body)];
        while let Some((at, body)) = stack.pop() {
            // Below another body, nothing depends on what is above.
            let is_body = bodies.contains(at);
            if (is_body && at != entity) || !seen.insert(at) {
                continue;
            }
            let body = if is_body { Some(at) } else { body };
            if let Ok((is_collider, held)) = colliders.get(at) {
                let wanted = body.filter(|_| is_collider);
                if wanted != held.map(|held| held.body) {
                    links.push((at, wanted));
                }
            }
            stack.extend(tree.children(at).iter().rev().map(|&child| (child, body)));
        }
    }
    if !links.is_empty() {
        commands.queue(move |world: &mut World| links.iter().for_each(|&(c, body)| attach(world, c, body)));
    }
}

/// Makes or removes one link. Users' observers run in between, so everything is looked up again.
fn attach(world: &mut World, collider: Entity, body: Option<Entity>) {
    let body = body.filter(|&body| world.get::<RigidBody>(body).is_some());
    let Ok(mut entity) = world.get_entity_mut(collider) else { return };
    match body.filter(|_| entity.contains::<ColliderMarker>()) {
        None => {
            entity.remove::<(ColliderOf, FollowsBody)>();
        }
        Some(body) if body == collider => {
            entity.remove::<FollowsBody>();
            if let Ok(mut entity) = world.get_entity_mut(collider) {
                entity.insert(ColliderOf { body });
            }
        }
        Some(body) => {
            entity.insert((ColliderOf { body }, FollowsBody));
            if let Ok(mut body) = world.get_entity_mut(body)
                && !body.contains::<CompoundBody>()
            {
                body.insert(CompoundBody);
            }
        }
    }
}
