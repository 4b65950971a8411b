//! Initialises the poses of new entities from their transforms, unless the app set the poses.

use bevy_ecs::{
    entity::EntityHashSet,
    entity_disabling::Disabled,
    prelude::*,
    system::{SystemChangeTick, SystemParam},
};
use bevy_transform::components::Transform;

use super::{
    PhysicsTransformConfig, Position, Rotation,
    frame::{read_pose, same_rotation, same_translation, write_pose},
    position::Originals,
    sync::{SyncTicks, parent_frame, warn_non_finite},
    tree::{FollowsBody, Parents},
};
use crate::{dynamics::rigid_body::RigidBody, math::Vector, noted::Noted, schedule::OnThisThread};

/// An entity that got its [`Position`] since the last step.
#[derive(Clone, Debug)]
pub(crate) struct Spawned {
    /// Whether the app set the position and the rotation.
    given: [bool; 2],
    /// The pose after the first initialisation.
    first: (Position, Option<Rotation>),
    /// For a clone, the pose given by the original's transform.
    cloned: Option<(Vector, Option<Rotation>)>,
}

/// Entities to initialise, in order of spawning, and entities that got a [`Rotation`].
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct SpawnQueue(Noted<Spawned>, Noted);

#[cfg(test)]
impl SpawnQueue {
    /// The number of queued entities.
    pub(crate) fn len(&self) -> usize {
        self.0.len() + self.1.len()
    }
}

/// Queries for initialising poses.
#[derive(SystemParam)]
pub(crate) struct Initialiser<'w, 's> {
    poses: Query<
        'w,
        's,
        (&'static mut Position, Option<&'static mut Rotation>, Has<RigidBody>, Has<FollowsBody>),
        Allow<Disabled>,
    >,
    transforms: Query<'w, 's, &'static mut Transform, Allow<Disabled>>,
    parents: Parents<'w, 's>,
    config: Res<'w, PhysicsTransformConfig>,
}

impl Initialiser<'_, '_> {
    /// The pose given by the transform of an entity.
    fn read(&self, entity: Entity) -> Option<(Vector, Option<Rotation>)> {
        let transform = self.transforms.get(entity).ok()?;
        let parent = parent_frame(entity, &self.parents, |e| self.transforms.get(e).ok().copied());
        Some(read_pose(parent.as_ref(), transform))
    }

    fn depth(&self, entity: Entity) -> usize {
        core::iter::successors(Some(entity), |&at| self.parents.get(at).ok().map(ChildOf::parent)).count()
    }

    /// Warns of a transform that is not finite, if a pose needs to be initialised from it.
    fn warn_non_finite(&self, entity: Entity, given: [bool; 2], reported: &mut EntityHashSet) {
        let Ok(transform) = self.transforms.get(entity) else { return };
        if given != [true; 2]
            && let Some((read, _)) = self.read(entity)
        {
            warn_non_finite(entity, transform, &read, reported);
        }
    }

    /// Writes the values that the app set to the `Transform`, and initialises the others from the
    /// `Transform`.
    fn initialise(&mut self, entity: Entity, given: [bool; 2]) {
        let Ok((mut position, mut rotation, ..)) = self.poses.get_mut(entity) else { return };
        let transform = self.transforms.get(entity).copied().unwrap_or_default();
        let parent = parent_frame(entity, &self.parents, |e| self.transforms.get(e).ok().copied());
        let (read, turned) = read_pose(parent.as_ref(), &transform);
        if !given[0] {
            position.0 = if read.is_finite() { read } else { Vector::ZERO };
        }
        if !given[1]
            && let Some(rotation) = &mut rotation
        {
            **rotation = turned.unwrap_or(Rotation::IDENTITY);
        }
        if !self.config.position_to_transform || given == [false; 2] {
            return;
        }
        let rotation = rotation.map_or(Rotation::IDENTITY, |rotation| *rotation);
        let written = write_pose(parent.as_ref(), &transform, position.0, rotation);
        if let Ok(mut transform) = self.transforms.get_mut(entity) {
            if given[0] && !same_translation(&transform, &written) {
                transform.translation = written.translation;
            }
            if given[1] && !same_rotation(&transform, &written) {
                transform.rotation = written.rotation;
            }
        }
    }
}

/// Initialises a new [`Position`] immediately, so that no system reads a placeholder. Ancestors may still be
/// missing or change, so [`initialise_poses`] checks again before the step.
pub(crate) fn initialise_added(
    added: On<Add, Position>,
    mut initialiser: Initialiser,
    mut queue: ResMut<SpawnQueue>,
    mut originals: ResMut<Originals>,
) {
    let entity = added.event_target();
    let Ok((position, rotation, ..)) = initialiser.poses.get(entity) else { return };
    let first = (*position, rotation.copied());
    if let Some(original) = originals.0.remove(&entity)
        && *position != Position::PLACEHOLDER
        && let Some(read) = initialiser.read(original)
    {
        queue.0.put(entity, Spawned { given: [false; 2], first, cloned: Some(read) });
        return;
    }
    let given = [*position != Position::PLACEHOLDER, rotation.is_some_and(|r| *r != Rotation::PLACEHOLDER)];
    initialiser.initialise(entity, given);
    let Ok((position, rotation, ..)) = initialiser.poses.get(entity) else { return };
    queue.0.put(entity, Spawned { given, first: (*position, rotation.copied()), cloned: None });
}

/// Records new rotations of entities that already had a position.
pub(crate) fn note_rotation(added: On<Add, Rotation>, mut queue: ResMut<SpawnQueue>) {
    queue.1.note(added.event_target());
}

/// Initialises the poses of new entities, ancestors first.
pub(crate) fn initialise_poses(
    mut queue: ResMut<SpawnQueue>,
    mut initialiser: Initialiser,
    mut ticks: ResMut<SyncTicks>,
    system: SystemChangeTick,
    _: OnThisThread,
) {
    ticks.read[0] = system.this_run();
    let mut spawned: Vec<(usize, Entity, Spawned)> =
        queue.0.drain().map(|(entity, new)| (initialiser.depth(entity), entity, new)).collect();
    spawned.sort_by_key(|&(depth, ..)| depth);
    for (_, entity, Spawned { given, first, cloned }) in spawned {
        let Ok((position, rotation, _, false)) = initialiser.poses.get(entity) else { continue };
        // A pose that the app set after spawning counts as given. The pose of a clone also counts as given if
        // the clone has the same transform as the original.
        let like = cloned.zip(initialiser.read(entity)).map(|(a, b)| [a.0 == b.0, a.1 == b.1]);
        let like = like.unwrap_or_default();
        let given = [
            given[0] || *position != first.0 || like[0],
            given[1] || rotation.copied() != first.1 || like[1],
        ];
        initialiser.initialise(entity, given);
        initialiser.warn_non_finite(entity, given, &mut ticks.reported);
    }
    for (entity, ()) in queue.1.drain() {
        let Ok((_, Some(rotation), ..)) = initialiser.poses.get(entity) else { continue };
        if *rotation == Rotation::PLACEHOLDER {
            initialiser.initialise(entity, [true, false]);
        }
    }
}
