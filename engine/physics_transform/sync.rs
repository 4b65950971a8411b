//! Synchronises `Transform` with [`Position`] and [`Rotation`]: transforms that the app changed are read before a step,
//! poses that changed are written after it.
//!
//! A `Transform` counts as changed by the app if its bits differ from what the write-back would store for the current
//! pose. So rounding never perturbs the pose of an untouched body, and the sync has no state to be stored or rolled
//! back. Change ticks only narrow the search.

use bevy_ecs::{
    change_detection::{CheckChangeTicks, ContiguousRef, Tick},
    entity::EntityHashSet,
    entity_disabling::Disabled,
    prelude::*,
    system::{SystemChangeTick, SystemParam},
};
use bevy_log::warn;
use bevy_transform::components::{GlobalTransform, Transform};

use super::{
    ApplyPosToTransform, PhysicsTransformConfig, Position, Rotation, dim,
    frame::{Frame, read_pose, same_pose, same_rotation, same_translation, write_pose},
    rotation64::Rotation64,
    tree::{FollowsBody, HierarchyQueue, Parents, Physical, TransformTree, TreeChanges},
};
use crate::{
    columns::{Column, is_change_tracked, pieces},
    dynamics::rigid_body::RigidBody,
    math::Vector,
    noted::Noted,
    scan::{IN_TABLES, Since},
    schedule::OnThisThread,
    threads::Threads,
};

/// Ticks of the last reads and writes.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct SyncTicks {
    /// The last scan of `Transform`.
    scan: Tick,
    /// The last write-back. Transforms that it wrote have this tick.
    writeback: Tick,
    /// The last initialisation and the last read. Poses that they wrote have these ticks. They came from transforms, so
    /// they need not be written back.
    read: [Tick; 2],
    /// Entities whose transform is not finite and was reported.
    reported: EntityHashSet,
}

impl SyncTicks {
    pub(crate) fn clamp(&mut self, check: CheckChangeTicks) {
        for tick in [&mut self.scan, &mut self.writeback].into_iter().chain(&mut self.read) {
            tick.check_tick(check);
        }
    }
}

/// An entity that got its [`Position`] since the last step.
#[derive(Clone, Debug)]
pub(crate) struct Spawned {
    /// Whether the app gave the position and the rotation.
    given: [bool; 2],
    /// The pose after the first initialisation.
    first: (Position, Option<Rotation>),
}

/// Entities to be initialised, in order of spawning, and those that got a [`Rotation`].
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct SpawnQueue(Noted<Spawned>, Noted);

#[cfg(test)]
impl SpawnQueue {
    /// The number of queued entities.
    pub(crate) fn len(&self) -> usize {
        self.0.len() + self.1.len()
    }
}

/// The frame of an entity's parent in the world, through all ancestors; `None` for a root. An ancestor without a
/// transform counts as the identity.
pub(crate) fn parent_frame(
    entity: Entity,
    parents: &Parents,
    transform: impl Fn(Entity) -> Option<Transform>,
) -> Option<Frame> {
    let mut line: Vec<Entity> = Vec::new();
    let mut at = entity;
    while let Ok(parent) = parents.get(at) {
        at = parent.parent();
        line.push(at);
    }
    if line.is_empty() {
        return None;
    }
    let chain = line.iter().rev().filter_map(|&ancestor| transform(ancestor));
    Some(chain.fold(Frame::IDENTITY, |frame, t| frame.child(&t)))
}

/// Finds transforms that changed since the last scan, except by the write-back. This is the only scan over all entities
/// with a `Transform`.
pub(crate) fn find_changed_transforms(
    transforms: Query<(Entity, Ref<Transform>, Option<Ref<GlobalTransform>>, Has<Position>, Has<Children>)>,
    tree: Res<TransformTree>,
    mut changes: ResMut<TreeChanges>,
    mut ticks: ResMut<SyncTicks>,
    system: SystemChangeTick,
    _: OnThisThread,
) {
    let TreeChanges { reparented, transforms: found, written, .. } = &mut *changes;
    found.append(&mut reparented.clone());
    let since = Since::new(ticks.scan, system);
    let matters =
        |entity, physical: bool, has_children: bool| physical || (has_children && tree.contains(entity));
    for (entities, transforms, global, physical, has_children) in
        transforms.contiguous_iter().expect(IN_TABLES)
    {
        if !physical && !has_children {
            continue;
        }
        let changed = transforms.changed_ticks_slice();
        let global = global.as_ref().map(ContiguousRef::changed_ticks_slice);
        let is_behind = |row: usize| {
            global.is_some_and(|global| changed[row].is_newer_than(global[row], system.this_run()))
        };
        since.rows([changed], |row| {
            if !matters(entities[row], physical, has_children) {
                return;
            }
            if changed[row] != ticks.writeback {
                found.push(entities[row]);
            } else if is_behind(row) {
                written.push(entities[row]);
            }
        });
    }
    ticks.scan = system.this_run();
}

/// Updates the `GlobalTransform` of bodies, colliders and their ancestors, if their own transform or one above changed
/// since the last step or was written after it. Bevy propagates once a frame, after any number of steps, and handles
/// all other entities.
pub(crate) fn propagate_global_transforms(
    changes: Res<TreeChanges>,
    mut tree: ResMut<TransformTree>,
    transforms: Query<&Transform>,
    parents: Parents,
    mut globals: Query<&mut GlobalTransform>,
    _: OnThisThread,
) {
    tree.begin_walk();
    for &entity in changes.transforms.iter().chain(&changes.written) {
        let mut above: Option<GlobalTransform> = None;
        if tree.parent(entity).is_some() {
            let line = core::iter::successors(Some(entity), |&at| parents.get(at).ok().map(ChildOf::parent));
            let line: Vec<&Transform> = line.skip(1).filter_map(|at| transforms.get(at).ok()).collect();
            let step = |global: GlobalTransform, local: &&Transform| global.mul_transform(**local);
            above = line.split_last().map(|(root, below)| below.iter().rev().fold((**root).into(), step));
        }
        tree.descend(entity, above, |entity, parent: &Option<GlobalTransform>| {
            let transform = *transforms.get(entity).ok()?;
            let global = parent.map_or_else(|| transform.into(), |parent| parent.mul_transform(transform));
            if let Ok(mut held) = globals.get_mut(entity) {
                held.set_if_neq(global);
            }
            Some(Some(global))
        });
    }
}

/// Warns of a transform that is not finite, once until it is finite again. The entity keeps its pose.
fn warn_non_finite(entity: Entity, transform: &Transform, read: &Vector, reported: &mut EntityHashSet) {
    if read.is_finite() && transform.rotation.is_finite() {
        if !reported.is_empty() {
            reported.remove(&entity);
        }
    } else if reported.insert(entity) {
        warn!("the transform of {entity}, or of an ancestor, is not finite; its pose does not follow it");
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
    fn depth(&self, entity: Entity) -> usize {
        core::iter::successors(Some(entity), |&at| self.parents.get(at).ok().map(ChildOf::parent)).count()
    }

    /// Warns of a transform that is not finite, if a pose was to be initialised from it.
    fn warn_non_finite(&self, entity: Entity, given: [bool; 2], reported: &mut EntityHashSet) {
        let Ok(transform) = self.transforms.get(entity) else { return };
        if given != [true; 2] {
            let parent = parent_frame(entity, &self.parents, |e| self.transforms.get(e).ok().copied());
            warn_non_finite(entity, transform, &read_pose(parent.as_ref(), transform).0, reported);
        }
    }

    /// Writes what the app gave to the `Transform`, and takes the rest from the `Transform`.
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

/// Initialises a new [`Position`] at once, so that no system reads a placeholder. Ancestors may still be missing or
/// change, so [`initialise_poses`] checks again before the step.
pub(crate) fn initialise_added(
    added: On<Add, Position>,
    mut initialiser: Initialiser,
    mut queue: ResMut<SpawnQueue>,
) {
    let entity = added.event_target();
    let Ok((position, rotation, ..)) = initialiser.poses.get(entity) else { return };
    let given = [*position != Position::PLACEHOLDER, rotation.is_some_and(|r| *r != Rotation::PLACEHOLDER)];
    initialiser.initialise(entity, given);
    let Ok((position, rotation, ..)) = initialiser.poses.get(entity) else { return };
    queue.0.put(entity, Spawned { given, first: (*position, rotation.copied()) });
}

/// Records new rotations of entities that had a position before.
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
    for (_, entity, Spawned { given, first }) in spawned {
        let Ok((position, rotation, _, false)) = initialiser.poses.get(entity) else { continue };
        // A pose set after spawning counts as given.
        let given = [given[0] || *position != first.0, given[1] || rotation.copied() != first.1];
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

/// Queries for reading transforms.
#[derive(SystemParam)]
pub struct TransformReader<'w, 's> {
    tree: ResMut<'w, TransformTree>,
    changes: Res<'w, TreeChanges>,
    ticks: ResMut<'w, SyncTicks>,
    config: Res<'w, PhysicsTransformConfig>,
    transforms: Query<'w, 's, &'static Transform>,
    parents: Parents<'w, 's>,
    poses: Query<'w, 's, (&'static mut Position, Option<&'static mut Rotation>), Without<FollowsBody>>,
}

/// Reads transforms that the app changed since the last step, or whose ancestors' transforms it changed, into
/// [`Position`] and [`Rotation`]. A position or rotation that was itself set since then is kept.
pub fn transform_to_position(reader: TransformReader, system: SystemChangeTick, _: OnThisThread) {
    let TransformReader { mut tree, changes, mut ticks, config, transforms, parents, mut poses } = reader;
    ticks.read[1] = system.this_run();
    let last = ticks.writeback;
    let reported = &mut ticks.reported;
    reported.retain(|entity| transforms.contains(*entity));
    let mut visit = |entity: Entity, parent: Option<&Frame>, transform: &Transform| {
        let Ok((mut position, rotation)) = poses.get_mut(entity) else { return };
        let held = rotation.as_ref().map_or(Rotation::IDENTITY, |rotation| **rotation);
        let expected = write_pose(parent, transform, position.0, held);
        let is_free = |changed: Tick| !changed.is_newer_than(last, system.this_run());
        let (read, turned) = read_pose(parent, transform);
        warn_non_finite(entity, transform, &read, reported);
        let moved = !same_translation(&expected, transform) && read.is_finite();
        if moved && is_free(position.last_changed()) && position.0 != read {
            position.0 = read;
        }
        let (Some(mut rotation), Some(turned)) = (rotation, turned) else { return };
        let current =
            parent.map_or(Rotation64::from_quat(transform.rotation), |f| f.child(transform).rotation());
        let rotated = !same_rotation(&expected, transform) && !dim::is_rounding(turned, held, current);
        if rotated && is_free(rotation.last_changed()) && *rotation != turned {
            *rotation = turned;
        }
    };
    tree.begin_walk();
    for &entity in &changes.transforms {
        let Ok(transform) = transforms.get(entity) else { continue };
        if !tree.contains(entity) {
            visit(entity, None, transform);
            continue;
        }
        let parent = parent_frame(entity, &parents, |e| transforms.get(e).ok().copied());
        tree.descend(entity, parent, |entity, parent: &Option<Frame>| {
            let transform = transforms.get(entity).ok()?;
            visit(entity, parent.as_ref(), transform);
            let below = || Some(parent.unwrap_or(Frame::IDENTITY).child(transform));
            config.propagate_before_physics.then(below)
        });
    }
}

/// Entities whose poses are written to transforms.
type Written = Or<(With<RigidBody>, With<ApplyPosToTransform>)>;

/// A pose, with its change ticks.
type Pose = (Entity, Ref<'static, Position>, Ref<'static, Rotation>);

/// Queries for writing transforms.
#[derive(SystemParam)]
pub struct TransformWriter<'w, 's> {
    tree: ResMut<'w, TransformTree>,
    ticks: ResMut<'w, SyncTicks>,
    config: Res<'w, PhysicsTransformConfig>,
    queries: ParamSet<
        'w,
        's,
        (
            Query<'w, 's, (Pose, &'static mut Transform), Written>,
            (Query<'w, 's, Pose, Written>, Query<'w, 's, &'static mut Transform>),
        ),
    >,
    parents: Parents<'w, 's>,
    following: Query<'w, 's, (), With<FollowsBody>>,
    hierarchy: Res<'w, HierarchyQueue>,
    changes: ResMut<'w, TreeChanges>,
    physical: Physical<'w, 's>,
    threads: Res<'w, Threads>,
    /// Entities that each thread found and that are written one by one.
    found: Local<'s, Vec<Vec<Entity>>>,
}

/// Writes poses that changed since the last write-back to `Transform`: of bodies, and of entities with
/// [`ApplyPosToTransform`]. Bodies below a moved one keep their world pose, so their transforms are written, too. Scale
/// is kept; in 2D also depth and tilt.
pub fn position_to_transform(mut writer: TransformWriter, system: SystemChangeTick, _: OnThisThread) {
    let TransformWriter {
        mut tree,
        mut ticks,
        config,
        mut queries,
        parents,
        following,
        threads,
        mut found,
        ..
    } = writer;
    let (last, read) = (ticks.writeback, ticks.read);
    let since = Since::new(last, system);
    ticks.writeback = system.this_run();
    if !config.position_to_transform {
        return;
    }
    // Excludes poses that were read from transforms in this step.
    let is_own = |tick: Tick| since.is_new(tick) && !read.contains(&tick);
    // Changes of the hierarchy by the app during the step.
    if !writer.hierarchy.is_empty() {
        let noted = writer.hierarchy.entities();
        tree.follow(&noted, &parents, &writer.physical, &mut writer.changes.early);
    }
    let looks_up = is_change_tracked();
    for (pose, transforms) in queries.p0().contiguous_iter_mut().expect(IN_TABLES) {
        let (entities, positions, rotations) = pose;
        let (at, turned) = (positions.changed_ticks_slice(), rotations.changed_ticks_slice());
        let mut changed = None;
        let mut column = Column::new(transforms, &mut changed);
        let pieces = pieces(entities.len()).map(|rows| (rows, column.cut()));
        threads.pool.each_into(&mut found, pieces, |late, (rows, mut column)| {
            let start = rows.start;
            since.rows([&at[rows.clone()], &turned[rows]], |i| {
                let row = start + i;
                if !is_own(at[row]) && !is_own(turned[row]) {
                    return;
                }
                if looks_up || tree.is_tied(entities[row]) {
                    late.push(entities[row]);
                    return;
                }
                let slot = column.slot(i);
                let written = write_pose(None, slot.get(), positions[row].0, rotations[row]);
                if !same_pose(slot.get(), &written) {
                    slot.set(written);
                }
            });
        });
    }
    // Entities in a hierarchy. All entities if tables cannot be written as a whole.
    let mut late: Vec<Entity> = Vec::new();
    found.iter_mut().for_each(|found| late.append(found));
    if late.is_empty() {
        return;
    }
    late.sort_unstable();
    let (poses, mut transforms) = queries.p1();
    let set: EntityHashSet = late.iter().copied().collect();
    tree.begin_walk();
    for &entity in &late {
        let above = |at: &Entity| tree.parent(*at);
        let line = core::iter::successors(Some(entity), above);
        let top = line.filter(|ancestor| set.contains(ancestor)).last().unwrap_or(entity);
        let parent = parent_frame(top, &parents, |e| transforms.get(e).ok().copied());
        tree.descend(top, parent, |entity, parent: &Option<Frame>| {
            if let Ok((_, position, rotation)) = poses.get(entity)
                && !following.contains(entity)
                && let Ok(mut transform) = transforms.get_mut(entity)
            {
                let written = write_pose(parent.as_ref(), &transform, position.0, *rotation);
                if !same_pose(&transform, &written) {
                    *transform = written;
                }
            }
            let transform = transforms.get(entity).ok()?;
            Some(Some(parent.unwrap_or(Frame::IDENTITY).child(transform)))
        });
    }
}
