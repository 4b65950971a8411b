//! Attaches colliders to bodies by the hierarchy.

use bevy_app::{App, Plugin};
use bevy_ecs::{
    entity::EntityHashSet,
    entity_disabling::Disabled,
    prelude::*,
    query::Allow,
    system::{SystemParam, SystemState},
};
use bevy_transform::components::Transform;

use super::{ColliderOf, CompoundBody, RigidBodyColliders};
use crate::{
    collision::collider::{ColliderMarker, collider_transform::ColliderTransform},
    dynamics::rigid_body::RigidBody,
    physics_transform::{
        Position, Rotation, filled_in,
        tree::{FollowsBody, HierarchyQueue, Parents, Physical, TransformTree, TreeChanges, enqueue},
    },
};

/// Updates [`ColliderOf`] and [`RigidBodyColliders`] from the hierarchy, at the end of the command
/// that changed it.
pub struct ColliderHierarchyPlugin;

/// Present if colliders are attached to bodies.
#[derive(Resource)]
pub(crate) struct AttachesColliders;

/// Present if colliders are placed on their bodies. Without it no collider is attached.
#[derive(Resource)]
pub(crate) struct PlacesColliders;

/// Entities at or below which colliders may have another body. Entities that changed in one command, for
/// instance a batch, are processed together.
#[derive(Resource, Default)]
pub(crate) struct AttachQueue {
    entities: Vec<Entity>,
    /// Whether the command that empties the queue is queued.
    is_called: bool,
}

impl AttachQueue {
    fn push(&mut self, entity: Entity, commands: &mut Commands) {
        if self.entities.last() != Some(&entity) {
            self.entities.push(entity);
        }
        if !core::mem::replace(&mut self.is_called, true) {
            commands.queue(attach_now);
        }
    }
}

impl Plugin for ColliderHierarchyPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<HierarchyQueue>()
            .init_resource::<TransformTree>()
            .init_resource::<TreeChanges>()
            .init_resource::<AttachQueue>()
            .init_resource::<LinkerState>()
            .insert_resource(AttachesColliders)
            .register_type::<(ColliderOf, RigidBodyColliders)>()
            .add_observer(enqueue::<Add, ColliderMarker>)
            .add_observer(enqueue::<Remove, ColliderMarker>)
            .add_observer(attach_soon::<Add, (RigidBody, ColliderMarker)>)
            .add_observer(attach_soon::<Remove, (RigidBody, ColliderMarker)>)
            .add_observer(attach_reparented::<Insert>)
            .add_observer(attach_reparented::<Remove>)
            .add_observer(adopt_explicit)
            .add_observer(leave_body)
            .add_observer(detach_at_once);
    }
}

fn attach_soon<E: EntityEvent, B: Bundle>(
    event: On<E, B>,
    mut queue: ResMut<AttachQueue>,
    mut commands: Commands,
) {
    queue.push(event.event_target(), &mut commands);
}

/// Queues an entity if it or a descendant has physics components.
fn attach_reparented<E: EntityEvent>(
    event: On<E, ChildOf>,
    tree: Res<TransformTree>,
    physical: Physical,
    mut queue: ResMut<AttachQueue>,
    mut commands: Commands,
) {
    let entity = event.event_target();
    if tree.contains(entity) || physical.contains(entity) {
        queue.push(entity, &mut commands);
    }
}

/// Processes a link that the app inserted. Links made by the hierarchy are complete.
fn adopt_explicit(
    inserted: On<Insert, ColliderOf>,
    links: Query<(&ColliderOf, Option<&FollowsBody>), Allow<Disabled>>,
    mut queue: ResMut<AttachQueue>,
    mut commands: Commands,
) {
    let collider = inserted.entity;
    if links.get(collider).is_ok_and(|(of, follows)| of.is_explicit(collider, follows)) {
        queue.push(collider, &mut commands);
    }
}

/// Stops a collider from following its body after the app removed its link.
fn leave_body(
    removed: On<Remove, ColliderOf>,
    following: Query<(), (With<FollowsBody>, Allow<Disabled>)>,
    mut commands: Commands,
) {
    let collider = removed.entity;
    if following.contains(collider) {
        commands.queue(move |world: &mut World| {
            if let Ok(mut entity) = world.get_entity_mut(collider)
                && !entity.contains::<ColliderOf>()
            {
                entity.remove::<FollowsBody>();
            }
        });
    }
}

/// Unlinks the colliders at and below an entity that leaves its parent, down to the next body. If the next
/// command despawns the old body, it must not despawn these colliders.
fn detach_at_once(
    left: On<Discard, ChildOf>,
    tree: Res<TransformTree>,
    bodies: Query<(), (With<RigidBody>, Allow<Disabled>)>,
    following: Query<&FollowsBody, Allow<Disabled>>,
    mut commands: Commands,
) {
    let top = left.event_target();
    if !tree.contains(top) && !following.contains(top) {
        return;
    }
    let mut stack = vec![top];
    while let Some(entity) = stack.pop() {
        if bodies.contains(entity) {
            continue;
        }
        if following.get(entity).is_ok_and(|follows| follows.above.is_some()) {
            commands.entity(entity).try_remove::<(ColliderOf, FollowsBody)>();
        }
        stack.extend_from_slice(tree.children(entity));
    }
}

/// A change to a collider's link.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// Link it to the body given by the hierarchy, or to none.
    Link(Option<Entity>),
    /// Let it follow the body given by the app.
    Adopt,
}

/// Queries for finding links.
#[derive(SystemParam)]
struct Linker<'w, 's> {
    tree: ResMut<'w, TransformTree>,
    changes: ResMut<'w, TreeChanges>,
    parents: Parents<'w, 's>,
    physical: Physical<'w, 's>,
    bodies: Query<'w, 's, (), (With<RigidBody>, Allow<Disabled>)>,
    colliders: Query<
        'w,
        's,
        (Has<ColliderMarker>, Option<&'static ColliderOf>, Option<&'static FollowsBody>),
        Allow<Disabled>,
    >,
}

/// Kept between calls, because building the state takes longer than using it.
#[derive(Resource)]
struct LinkerState(Option<SystemState<Linker<'static, 'static>>>);

impl FromWorld for LinkerState {
    fn from_world(world: &mut World) -> Self {
        Self(Some(SystemState::new(world)))
    }
}

impl Linker<'_, '_> {
    /// The changes of links at and below the entities, in order.
    fn find(&mut self, entities: &[Entity]) -> Vec<(Entity, Step)> {
        self.tree.follow(entities, &self.parents, &self.physical, &mut self.changes.early);
        let mut seen = EntityHashSet::default();
        let mut steps = Vec::new();
        for &entity in entities {
            let above = |at: &Entity| self.parents.get(*at).ok().map(ChildOf::parent);
            let mut line = core::iter::successors(above(&entity), above);
            let body = line.find(|&ancestor| self.bodies.contains(ancestor));
            let mut stack = vec![(entity, body)];
            while let Some((at, body)) = stack.pop() {
                // Below another body, links do not depend on ancestors of that body.
                let is_body = self.bodies.contains(at);
                if (is_body && at != entity) || !seen.insert(at) {
                    continue;
                }
                let body = if is_body { Some(at) } else { body };
                steps.extend(self.step(at, body).map(|step| (at, step)));
                stack.extend(self.tree.children(at).iter().rev().map(|&child| (child, body)));
            }
        }
        steps
    }

    fn step(&self, at: Entity, body: Option<Entity>) -> Option<Step> {
        let (is_collider, held, follows) = self.colliders.get(at).ok()?;
        let wanted = body.filter(|_| is_collider);
        let explicit = held.filter(|held| held.is_explicit(at, follows));
        match explicit {
            None if wanted == held.map(|held| held.body) => None,
            Some(of) if Some(of.body) != wanted => {
                let is_adopted = follows.is_some_and(|follows| follows.above.is_none());
                (is_collider && !is_adopted).then_some(Step::Adopt)
            }
            _ => Some(Step::Link(wanted)),
        }
    }
}

/// Attaches the colliders at and below every queued entity to the nearest body.
pub(crate) fn attach_now(world: &mut World) {
    let Some(mut queue) = world.get_resource_mut::<AttachQueue>() else { return };
    queue.is_called = false;
    let mut entities = core::mem::take(&mut queue.entities);
    if entities.is_empty() || !world.contains_resource::<PlacesColliders>() {
        return;
    }
    if entities.len() > 1 {
        let mut seen = EntityHashSet::default();
        entities.retain(|entity| seen.insert(*entity));
    }
    let state = |world: &mut World| world.resource_mut::<LinkerState>().0.take();
    let Some(mut linker) = state(world) else { return };
    let steps = linker.get_mut(world).map(|mut linker| linker.find(&entities)).unwrap_or_default();
    world.resource_mut::<LinkerState>().0 = Some(linker);
    let mut links = Vec::new();
    for (collider, step) in steps {
        match step {
            Step::Link(body) => links.push((collider, body)),
            Step::Adopt => adopt(world, collider),
        }
    }
    if !links.is_empty() {
        attach_to_themselves(world, &mut links);
        links.iter().for_each(|&(collider, body)| attach(world, collider, body));
    }
}

/// Links new bodies that are their own colliders, with one archetype move for link and list, and removes them
/// from `links`.
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
    // Commands of observers are applied before the other links are made.
    world.flush();
}

/// Makes or removes one link. Observers of the app run in between, so all data is looked up again.
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
            entity.insert((ColliderOf { body }, FollowsBody { above: Some(body) }));
            mark_compound(world, body);
        }
    }
}

fn mark_compound(world: &mut World, body: Entity) {
    if let Ok(mut body) = world.get_entity_mut(body)
        && !body.contains::<CompoundBody>()
    {
        body.insert(CompoundBody);
    }
}

/// Makes a collider follow the body given by the app. If the app gave no pose on the body, the collider keeps
/// the world pose of its `Transform`.
fn adopt(world: &mut World, collider: Entity) {
    let Some(&ColliderOf { body }) = world.get::<ColliderOf>(collider) else { return };
    let offset = offset_from_body(world, collider, body);
    let Ok(mut entity) = world.get_entity_mut(collider) else { return };
    if let Some(offset) = offset
        && let Some(mut held) = entity.get_mut::<ColliderTransform>()
    {
        held.translation = offset.translation;
        held.rotation = offset.rotation;
    }
    entity.insert(FollowsBody { above: None });
    mark_compound(world, body);
}

/// The pose of a collider on its body from both transforms. `None` if the app set the pose on the body, or
/// did not place the collider at all.
fn offset_from_body(world: &World, collider: Entity, body: Entity) -> Option<ColliderTransform> {
    let held = world.get::<ColliderTransform>(collider)?;
    let is_placed = world.get::<Transform>(collider).is_some_and(|own| {
        own.translation != Transform::IDENTITY.translation || own.rotation != Transform::IDENTITY.rotation
    });
    let is_given = held.translation != ColliderTransform::default().translation
        || held.rotation != ColliderTransform::default().rotation;
    if is_given || !(is_placed || world.get::<ChildOf>(collider).is_some()) {
        return None;
    }
    let pose = |entity: Entity| Some((world.get::<Position>(entity)?, world.get::<Rotation>(entity)?));
    let ((position, rotation), (at, turned)) = (pose(collider)?, pose(body)?);
    let back = filled_in(*turned).inverse();
    Some(ColliderTransform {
        translation: back * (position.0 - at.0),
        rotation: back * filled_in(*rotation),
        ..*held
    })
}
