//! Attaches colliders to bodies as the hierarchy says.

use bevy_app::{App, Plugin};
use bevy_ecs::{entity::EntityHashSet, entity_disabling::Disabled, prelude::*, query::Allow};

use super::{ColliderOf, CompoundBody, RigidBodyColliders};
use crate::{
    collision::collider::ColliderMarker,
    dynamics::rigid_body::RigidBody,
    physics_transform::tree::{FollowsBody, HierarchyQueue, Parents, TransformTree, TreeChanges, enqueue},
    schedule::OnThisThread,
};

/// Keeps [`ColliderOf`] and [`RigidBodyColliders`] as the hierarchy says. The links are made by a system in
/// the schedule of [`ColliderTransformPlugin`](crate::collision::collider::collider_transform::ColliderTransformPlugin).
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
            .add_observer(enqueue::<Add, ColliderMarker>)
            .add_observer(enqueue::<Remove, ColliderMarker>)
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
    (mut seen, _): (Local<EntityHashSet>, OnThisThread),
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
        commands.queue(move |world: &mut World| {
            attach_to_themselves(world, &mut links);
            links.iter().for_each(|&(collider, body)| attach(world, collider, body));
        });
    }
}

/// Makes the links of new bodies that are colliders themselves, with one move between tables for the link
/// and the list, and takes them from `links`.
fn attach_to_themselves(world: &mut World, links: &mut Vec<(Entity, Option<Entity>)>) {
    let mut own = Vec::new();
    links.retain(|&(collider, body)| {
        let is_new = |entity: EntityRef| {
            entity.contains::<RigidBody>()
                && entity.contains::<ColliderMarker>()
                && !entity.contains::<ColliderOf>()
                && !entity.contains::<RigidBodyColliders>()
                && !entity.contains::<FollowsBody>()
        };
        let taken = body == Some(collider) && world.get_entity(collider).is_ok_and(is_new);
        if taken {
            own.push((collider, (ColliderOf { body: collider }, RigidBodyColliders(vec![collider]))));
        }
        !taken
    });
    world.insert_batch(own);
    // What observers of these ask for is done before the other links are looked at.
    world.flush();
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
