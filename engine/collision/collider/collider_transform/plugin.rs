//! Updates [`ColliderTransform`]s, and the world poses of colliders that are children of a body.

use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::{
    change_detection::Tick,
    intern::Interned,
    prelude::*,
    schedule::ScheduleLabel,
    system::{SystemChangeTick, SystemParam, SystemState},
};
use bevy_transform::components::Transform;

use super::{ColliderTransform, UpdateColliderTransforms};
use crate::{
    collision::collider::{
        ColliderMarker,
        collider_hierarchy::{
            AttachesColliders, ColliderOf, CompoundBody, PlacesColliders, RigidBodyColliders, attach_now,
        },
    },
    dynamics::rigid_body::{RigidBody, mass_properties::MassPropertyQueue},
    math::vector_from_xyz,
    noted::Noted,
    physics_transform::{
        PhysicsTransformSystems, Position, Rotation, filled_in,
        frame::Frame,
        plugin::TransformTreePlugin,
        rotation_from_f64,
        sync::{
            find_changed_transforms, position_to_transform, propagate_global_transforms,
            transform_to_position,
        },
        tree::{FollowsBody, HierarchyQueue, Parents, TransformTree, TreeChanges},
    },
    schedule::OnThisThread,
};

/// Updates [`ColliderTransform`]s, and the poses of colliders that are children of a body.
pub struct ColliderTransformPlugin {
    schedule: Interned<dyn ScheduleLabel>,
}

impl ColliderTransformPlugin {
    /// Runs in `schedule`, which must have the sets of [`PhysicsSystems`](crate::schedule::PhysicsSystems).
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern() }
    }
}

impl Default for ColliderTransformPlugin {
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl Plugin for ColliderTransformPlugin {
    fn build(&self, app: &mut App) {
        use PhysicsTransformSystems::{PositionToTransform, Propagate, TransformToPosition};
        TransformTreePlugin::ensure(app, self.schedule);
        // Registration fails only if the requirement exists already.
        let _ =
            app.try_register_required_components_with::<ColliderMarker, Position>(|| Position::PLACEHOLDER);
        let _ =
            app.try_register_required_components_with::<ColliderMarker, Rotation>(|| Rotation::PLACEHOLDER);
        let _ = app.try_register_required_components::<ColliderMarker, ColliderTransform>();
        app.init_resource::<HierarchyQueue>()
            .init_resource::<Placement>()
            .init_resource::<PlacerState>()
            .insert_resource(PlacesColliders)
            .register_type::<ColliderTransform>()
            .add_observer(note_attached)
            .add_systems(
                self.schedule,
                (
                    attach_now
                        .run_if(resource_exists::<AttachesColliders>)
                        .after(find_changed_transforms)
                        .after(propagate_global_transforms)
                        .in_set(Propagate),
                    (update_collider_transforms.in_set(UpdateColliderTransforms), place_child_colliders)
                        .chain()
                        .in_set(TransformToPosition)
                        .after(transform_to_position),
                    place_child_colliders.in_set(PositionToTransform).after(position_to_transform),
                ),
            );
    }
}

/// Colliders to be placed.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Placement {
    /// Colliders that were attached to another body since the last step.
    attached: Noted,
    /// Colliders that wait for the command that computes their transform on the body.
    unplaced: Vec<Entity>,
    /// Colliders whose transform relative to their body changed.
    offset: Vec<Entity>,
    last: Tick,
}

#[cfg(test)]
impl Placement {
    /// Number of recorded colliders.
    pub(crate) fn len(&self) -> usize {
        self.attached.len() + self.offset.len()
    }
}

fn note_attached(
    attached: On<Insert, (ColliderOf, ColliderMarker)>,
    mut placement: ResMut<Placement>,
    mut commands: Commands,
) {
    let collider = attached.event_target();
    placement.attached.note(collider);
    // The first collider queues the command for all.
    if placement.unplaced.is_empty() {
        commands.queue(place_now);
    }
    placement.unplaced.push(collider);
}

/// Queries for a collider's pose on its body.
#[derive(SystemParam)]
struct Placer<'w, 's> {
    placement: ResMut<'w, Placement>,
    transforms: Query<'w, 's, (&'static Transform, Has<RigidBody>)>,
    parents: Parents<'w, 's>,
    colliders: Offsets<'w, 's>,
    weights: MassPropertyQueue<'w, 's>,
}

type Offsets<'w, 's> = Query<
    'w,
    's,
    (&'static mut ColliderTransform, Option<&'static ColliderOf>, Option<&'static FollowsBody>),
>;

/// Sets the transform of a collider on its body. Returns whether it changed. If the app attached the
/// collider, only the scale is taken from the transforms.
fn put_offset(colliders: &mut Offsets, entity: Entity, offset: ColliderTransform) -> bool {
    let Ok((mut held, of, follows)) = colliders.get_mut(entity) else { return false };
    let is_explicit = of.is_some_and(|of| of.is_explicit(entity, follows));
    let offset = if is_explicit { ColliderTransform { scale: offset.scale, ..*held } } else { offset };
    held.set_if_neq(offset)
}

/// Kept between calls, because building the state takes longer than using it.
#[derive(Resource)]
struct PlacerState(Option<SystemState<Placer<'static, 'static>>>);

impl FromWorld for PlacerState {
    fn from_world(world: &mut World) -> Self {
        Self(Some(SystemState::new(world)))
    }
}

/// Computes the [`ColliderTransform`]s of newly attached colliders at the end of the command that
/// attached them.
fn place_now(world: &mut World) {
    let Some(mut state) = world.get_resource_mut::<PlacerState>().and_then(|mut state| state.0.take()) else {
        return;
    };
    if let Ok(Placer { mut placement, transforms, parents, mut colliders, mut weights }) =
        state.get_mut(world)
    {
        for entity in placement.unplaced.drain(..) {
            if let Ok((transform, is_body)) = transforms.get(entity) {
                let path = path_above(entity, &parents, &transforms).child(is_body, transform);
                if put_offset(&mut colliders, entity, path.collider_transform()) {
                    weights.push(entity);
                }
            }
        }
    }
    state.apply(world);
    world.resource_mut::<PlacerState>().0 = Some(state);
}

/// Position of a walk down the hierarchy.
#[derive(Clone, Copy)]
struct Path {
    world: Frame,
    /// Nearest body at or above, and the frame relative to it.
    body: Option<Frame>,
}

impl Path {
    fn child(&self, is_body: bool, transform: &Transform) -> Self {
        let world = self.world.child(transform);
        let body = if is_body { Some(world.unposed()) } else { self.body.map(|f| f.child(transform)) };
        Self { world, body }
    }

    fn collider_transform(&self) -> ColliderTransform {
        let frame = self.body.unwrap_or_else(|| self.world.unposed());
        ColliderTransform {
            translation: vector_from_xyz(frame.translation()),
            rotation: rotation_from_f64(frame.rotation()),
            scale: vector_from_xyz(frame.scale()),
        }
    }
}

/// Recomputes [`ColliderTransform`]s at and below changed transforms, and of newly attached colliders.
pub(crate) fn update_collider_transforms(
    changes: Res<TreeChanges>,
    mut tree: ResMut<TransformTree>,
    mut placement: ResMut<Placement>,
    transforms: Query<(&Transform, Has<RigidBody>)>,
    parents: Parents,
    mut colliders: Offsets,
    _: OnThisThread,
) {
    let attached = placement.attached.take();
    tree.begin_walk();
    for &entity in changes.transforms.iter().chain(&attached) {
        let above = path_above(entity, &parents, &transforms);
        tree.descend(entity, above, |entity, path: &Path| {
            let (transform, is_body) = transforms.get(entity).ok()?;
            let path = path.child(is_body, transform);
            if put_offset(&mut colliders, entity, path.collider_transform()) {
                placement.offset.push(entity);
            }
            Some(path)
        });
    }
    placement.offset.extend(attached);
}

/// The path from the root to the parent of an entity.
fn path_above(entity: Entity, parents: &Parents, transforms: &Query<(&Transform, Has<RigidBody>)>) -> Path {
    let above = |at: &Entity| parents.get(*at).ok().map(ChildOf::parent);
    let line: Vec<Entity> = core::iter::successors(above(&entity), above).collect();
    let root = Path { world: Frame::IDENTITY, body: None };
    line.iter().rev().filter_map(|&e| transforms.get(e).ok()).fold(root, |path, (t, b)| path.child(b, t))
}

/// Sets the world poses of colliders that follow a body, if the body moved or the offset changed.
pub(crate) fn place_child_colliders(
    mut placement: ResMut<Placement>,
    bodies: Query<
        (Entity, Ref<Position>, Ref<Rotation>, &RigidBodyColliders),
        (With<CompoundBody>, Without<FollowsBody>),
    >,
    mut children: Query<(&mut Position, &mut Rotation, &ColliderTransform, &ColliderOf), With<FollowsBody>>,
    system: SystemChangeTick,
    _: OnThisThread,
) {
    let last = core::mem::replace(&mut placement.last, system.this_run());
    let mut place = |collider: Entity, body: Option<(&Position, Rotation)>| {
        let Ok((mut position, mut rotation, offset, of)) = children.get_mut(collider) else { return };
        let own = || bodies.get(of.body).ok().map(|(_, at, turned, _)| (at.into_inner(), filled_in(*turned)));
        let Some((at, turned)) = body.or_else(own) else { return };
        position.set_if_neq(Position(at.0 + turned * offset.translation));
        rotation.set_if_neq(turned * offset.rotation);
    };
    placement.offset.drain(..).for_each(|collider| place(collider, None));
    for (_, position, rotation, colliders) in &bodies {
        let is_new = |tick: Tick| tick.is_newer_than(last, system.this_run());
        if is_new(position.last_changed()) || is_new(rotation.last_changed()) {
            let body = (position.into_inner(), filled_in(*rotation));
            colliders.into_iter().for_each(|collider| place(collider, Some(body)));
        }
    }
}
