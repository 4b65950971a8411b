//! Synchronises `Transform` with [`Position`] and [`Rotation`]: transforms that the app changed are read
//! before a step, poses that changed are written after it.
//!
//! A `Transform` counts as changed by the app if its bits differ from the bits that the write-back would
//! store for the current pose. Therefore rounding never perturbs the pose of an untouched body, and the
//! synchronisation has no state to store or roll back. Change ticks only narrow the search.

use bevy_ecs::{
    change_detection::{CheckChangeTicks, ContiguousRef, Tick},
    entity::EntityHashSet,
    prelude::*,
    system::{SystemChangeTick, SystemParam},
};
use bevy_log::warn;
use bevy_transform::components::{GlobalTransform, Transform};

use super::{
    ApplyPosToTransform, PhysicsTransformConfig, Position, Rotation, dim,
    follow::Followed,
    frame::{Frame, read_pose, same_pose, same_rotation, same_translation, write_pose},
    rotation64::Rotation64,
    tree::{FollowsBody, HierarchyQueue, Parents, Physical, TransformTree, TreeChanges},
};
use crate::{
    columns::{Column, is_change_tracked, pieces},
    dynamics::rigid_body::{RigidBody, RigidBodyDisabled},
    math::Vector,
    scan::{IN_TABLES, Since},
    schedule::OnThisThread,
    threads::Threads,
};

/// Ticks of the last reads and writes.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct SyncTicks {
    /// The tick of the last scan of `Transform`.
    scan: Tick,
    /// The ticks of the last two write-backs, the later first: one follows the solver, the other the step.
    /// The transforms that they wrote have these ticks.
    writeback: [Tick; 2],
    /// The ticks of the last initialisation and the last read. The poses that they wrote have these ticks.
    /// These poses came from transforms, so they need not be written back.
    pub(super) read: [Tick; 2],
    /// Entities with a transform that is not finite and was reported.
    pub(super) reported: EntityHashSet,
}

impl SyncTicks {
    pub(crate) fn clamp(&mut self, check: CheckChangeTicks) {
        let ticks = core::iter::once(&mut self.scan).chain(&mut self.writeback).chain(&mut self.read);
        ticks.for_each(|tick| _ = tick.check_tick(check));
    }
}

/// The frame of an entity's parent in the world, through all ancestors. `None` for a root. An ancestor
/// without a transform counts as the identity.
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

/// Finds transforms that changed since the last scan, except by the write-back. No other system scans all
/// entities with a `Transform`.
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
            if !ticks.writeback.contains(&changed[row]) {
                found.push(entities[row]);
            } else if is_behind(row) {
                written.push(entities[row]);
            }
        });
    }
    ticks.scan = system.this_run();
}

/// Updates the `GlobalTransform` of bodies, colliders and their ancestors, if their own transform or a
/// transform above changed since the last step or was written after it. Bevy propagates once a frame, after
/// any number of steps, and updates all other entities.
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
pub(super) fn warn_non_finite(
    entity: Entity,
    transform: &Transform,
    read: &Vector,
    reported: &mut EntityHashSet,
) {
    if read.is_finite() && transform.rotation.is_finite() {
        if !reported.is_empty() {
            reported.remove(&entity);
        }
    } else if reported.insert(entity) {
        warn!("the transform of {entity}, or of an ancestor, is not finite; its pose does not follow it");
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
    poses: Query<'w, 's, Readable, Without<FollowsBody>>,
}

/// A pose that receives a transform, and the state of following it.
type Readable = (&'static mut Position, Option<&'static mut Rotation>, Option<&'static Followed>);

/// Reads a transform into a pose, separately for position and rotation: if its bits differ from the bits that
/// would be written for the pose, and the app did not set the pose.
fn read_into(
    mut position: Mut<Position>,
    rotation: Option<Mut<Rotation>>,
    parent: Option<&Frame>,
    transform: &Transform,
    is_free: impl Fn(Tick) -> bool,
) {
    let held = rotation.as_ref().map_or(Rotation::IDENTITY, |rotation| **rotation);
    let expected = write_pose(parent, transform, position.0, held);
    let (read, turned) = read_pose(parent, transform);
    let moved = !same_translation(&expected, transform) && read.is_finite();
    if moved && is_free(position.last_changed()) && position.0 != read {
        position.0 = read;
    }
    let (Some(mut rotation), Some(turned)) = (rotation, turned) else { return };
    let current = parent.map_or(Rotation64::from_quat(transform.rotation), |f| f.child(transform).rotation());
    let rotated = !same_rotation(&expected, transform) && !dim::is_rounding(turned, held, current);
    if rotated && is_free(rotation.last_changed()) && *rotation != turned {
        *rotation = turned;
    }
}

/// Reads transforms into [`Position`] and [`Rotation`], if the app changed the entity's or an ancestor's
/// transform since the last step. A position or rotation that was also set since then is kept.
pub fn transform_to_position(reader: TransformReader, system: SystemChangeTick, _: OnThisThread) {
    let TransformReader { mut tree, changes, mut ticks, config, transforms, parents, mut poses } = reader;
    ticks.read[1] = system.this_run();
    let [last, _] = ticks.writeback;
    let reported = &mut ticks.reported;
    reported.retain(|entity| transforms.contains(*entity));
    let mut visit = |entity: Entity, parent: Option<&Frame>, transform: &Transform| {
        let Ok((position, rotation, followed)) = poses.get_mut(entity) else { return };
        if followed.is_some_and(Followed::is_led) {
            return;
        }
        warn_non_finite(entity, transform, &read_pose(parent, transform).0, reported);
        read_into(position, rotation, parent, transform, |changed| {
            !changed.is_newer_than(last, system.this_run())
        });
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

/// A pose to read or write, whether its body is disabled, and the state of following its transform.
type PoseMut =
    (&'static mut Position, &'static mut Rotation, Has<RigidBodyDisabled>, Option<&'static Followed>);

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
            Query<'w, 's, (Pose, &'static mut Transform, Has<Followed>), Written>,
            (Query<'w, 's, PoseMut, Written>, Query<'w, 's, &'static mut Transform>),
        ),
    >,
    parents: Parents<'w, 's>,
    following: Query<'w, 's, (), With<FollowsBody>>,
    hierarchy: Res<'w, HierarchyQueue>,
    changes: ResMut<'w, TreeChanges>,
    physical: Physical<'w, 's>,
    threads: Res<'w, Threads>,
    /// Entities that each thread found and that must be written one by one.
    found: Local<'s, Vec<Vec<Entity>>>,
}

/// Writes poses that changed since the last write-back to `Transform`, for bodies and for entities with
/// [`ApplyPosToTransform`]. Bodies below a moved body keep their world pose, so their transforms are also
/// written. Disabled bodies below it keep their transform, and move with it. Scale is kept; in 2D also depth
/// and tilt.
///
/// It runs twice. The first run follows the solver, so that a `Transform` that the app sets later in the step
/// is newer than the pose. The second run follows the step, for poses that the app sets in the step.
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
    let ([last, _], read) = (ticks.writeback, ticks.read);
    let since = Since::new(last, system);
    ticks.writeback = [system.this_run(), last];
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
    for (pose, transforms, follow) in queries.p0().contiguous_iter_mut().expect(IN_TABLES) {
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
                if looks_up || follow || tree.is_tied(entities[row]) {
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
    let (mut poses, mut transforms) = queries.p1();
    let set: EntityHashSet = late.iter().copied().collect();
    tree.begin_walk();
    for &entity in &late {
        let above = |at: &Entity| tree.parent(*at);
        let line = core::iter::successors(Some(entity), above);
        let top = line.filter(|ancestor| set.contains(ancestor)).last().unwrap_or(entity);
        let parent = parent_frame(top, &parents, |e| transforms.get(e).ok().copied());
        tree.descend(top, parent, |entity, parent: &Option<Frame>| {
            if let Ok((position, rotation, is_disabled, followed)) = poses.get_mut(entity)
                && !following.contains(entity)
                && !followed.is_some_and(Followed::is_led)
                && let Ok(mut transform) = transforms.get_mut(entity)
            {
                let changed = [position.last_changed(), rotation.last_changed()];
                if is_disabled && parent.is_some() && !changed.into_iter().any(is_own) {
                    read_into(position, Some(rotation), parent.as_ref(), &transform, |_| true);
                } else {
                    let written = write_pose(parent.as_ref(), &transform, position.0, *rotation);
                    if !same_pose(&transform, &written) {
                        *transform = written;
                    }
                }
            }
            let transform = transforms.get(entity).ok()?;
            Some(Some(parent.unwrap_or(Frame::IDENTITY).child(transform)))
        });
    }
}
