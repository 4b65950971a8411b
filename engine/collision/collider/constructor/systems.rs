//! Makes colliders of constructors: hierarchies give constructors to descendants, constructors insert
//! colliders, and hierarchies whose descendants are done are removed.

use bevy_ecs::{
    change_detection::DetectChanges,
    entity::EntityHashSet,
    name::{Name, NameOrEntity},
    prelude::{
        Children, Commands, Component, Entity, EntityWorldMut, Has, IntoSystem, Local, Or, Query, Ref, With,
        World,
    },
};
use bevy_log::{warn, warn_once};

use super::{
    ColliderConstructor, ColliderConstructorHierarchy, ColliderConstructorHierarchyReady,
    ColliderConstructorReady, hierarchy::Choice, made::Made, mesh::Meshes, scene::Scenes,
};
use crate::collision::collider::Collider;

/// The descendants that a hierarchy waits for.
#[derive(Component)]
pub(super) struct Awaited(Vec<Entity>);

/// Entities that the systems work on.
type HasConstructor = Or<(With<ColliderConstructor>, With<ColliderConstructorHierarchy>, With<Awaited>)>;

/// Whether the systems have any work.
pub(super) fn are_any(work: Query<(), HasConstructor>) -> bool {
    !work.is_empty()
}

/// Makes colliders in a command. As a chain of systems, most frames would pay for two points of
/// synchronisation without any work.
pub(super) fn construct(mut commands: Commands) {
    commands.queue(|world: &mut World| {
        run(world, give_constructors);
        run(world, make_colliders);
        run(world, finish_hierarchies);
    });
}

/// Runs a system and its commands.
fn run<M, S: IntoSystem<(), (), M> + 'static>(world: &mut World, system: S) {
    let done = world.run_system_cached(system);
    debug_assert!(done.is_ok(), "all parameters are optional or queries");
}

/// Gives descendants of new or changed hierarchies their constructors, once scenes are spawned.
fn give_constructors(
    hierarchies: Query<(Ref<ColliderConstructorHierarchy>, Option<&Awaited>, NameOrEntity)>,
    children: Query<&Children>,
    descendants: Query<(Option<&Name>, Option<&ColliderConstructor>, Has<Collider>)>,
    meshes: Meshes,
    scenes: Scenes,
    mut commands: Commands,
) {
    for (hierarchy, awaited, name) in &hierarchies {
        let root = name.entity;
        if awaited.is_some() && !hierarchy.is_changed() {
            continue;
        }
        if !Scenes::ARE_KNOWN && children.get(root).is_err() {
            warn_once!(
                "the ColliderConstructorHierarchy of {name} has no descendants yet. It waits for the first ones, and \
                 cannot see whether a scene is still being loaded: that needs feature `bevy_scene`"
            );
            continue;
        }
        let below = || children.iter_descendants(root);
        if scenes.is_awaited(root) || below().any(|entity| scenes.is_awaited(entity)) {
            continue;
        }
        let mut awaited = Vec::new();
        for entity in below() {
            let Ok((name, own, has_collider)) = descendants.get(entity) else { continue };
            let choice = hierarchy.choice(name.map(Name::as_str));
            let choice = choice.filter(|choice| !meshes.lacks(entity, choice.constructor));
            match choice {
                Some(choice) if choice.is_named || own.is_none() && !has_collider => {
                    give(&mut commands, entity, &choice);
                    awaited.push(entity);
                }
                _ if own.is_some() => awaited.push(entity),
                _ => {}
            }
        }
        commands.entity(root).try_insert(Awaited(awaited));
    }
}

/// Gives a descendant its constructor, layers and density.
fn give(commands: &mut Commands, entity: Entity, choice: &Choice) {
    let mut entity = commands.entity(entity);
    let surroundings = (choice.layers, choice.density);
    match choice.is_named {
        true => entity.try_insert(surroundings),
        false => entity.try_insert_if_new(surroundings),
    };
    entity.try_insert(choice.constructor.clone());
}

/// Inserts the colliders of constructors, or reports why a constructor made none.
fn make_colliders(
    constructors: Query<(&ColliderConstructor, NameOrEntity)>,
    mut meshes: Meshes,
    mut warned: Local<EntityHashSet>,
    mut commands: Commands,
) {
    warned.retain(|entity| constructors.contains(*entity));
    meshes.begin();
    for (constructor, name) in &constructors {
        let entity = name.entity;
        let collider = match meshes.make(entity, constructor) {
            Made::Collider(collider) => Some(collider),
            Made::Never(fault) => {
                warn!("{name} gets no collider from its ColliderConstructor: {fault}");
                None
            }
            #[cfg(feature = "collider-from-mesh")]
            Made::Later => continue,
            #[cfg(feature = "collider-from-mesh")]
            Made::Lacks(what) => {
                if warned.insert(entity) {
                    warn!("{name} gets no collider yet: its ColliderConstructor {what}");
                }
                continue;
            }
        };
        commands.entity(entity).queue_silenced(settle(collider));
    }
}

/// Removes the constructor of an entity, and inserts the collider it made.
fn settle(collider: Option<Collider>) -> impl FnOnce(EntityWorldMut) + Send + 'static {
    move |mut entity| {
        if entity.take::<ColliderConstructor>().is_none() {
            // The constructor was removed meanwhile.
            return;
        }
        if let Some(collider) = collider {
            let id = entity.id();
            entity.insert(collider);
            entity.world_scope(|world| world.trigger(ColliderConstructorReady { entity: id }));
        }
    }
}

/// Removes hierarchies whose descendants have no constructors any more, and triggers their event.
fn finish_hierarchies(
    hierarchies: Query<(Entity, &Awaited, Has<ColliderConstructorHierarchy>)>,
    constructors: Query<(), With<ColliderConstructor>>,
    mut commands: Commands,
) {
    for (root, awaited, is_wanted) in &hierarchies {
        if is_wanted && awaited.0.iter().any(|entity| constructors.contains(*entity)) {
            continue;
        }
        commands.entity(root).queue_silenced(move |mut entity: EntityWorldMut| {
            entity.remove::<(Awaited, ColliderConstructorHierarchy)>();
            if is_wanted {
                entity.world_scope(|world| world.trigger(ColliderConstructorHierarchyReady { entity: root }));
            }
        });
    }
}
