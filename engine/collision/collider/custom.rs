//! Collider types of the app in the tables. The kernel sees them as boxes; the type itself computes contacts.

use bevy_app::App;
use bevy_ecs::{
    entity_disabling::Disabled,
    prelude::*,
    system::{StaticSystemParam, SystemParamItem},
};
use bevy_log::warn;
use core::any::TypeId;
use kernel::shape::{Aabb, Foreign, Shape};

use super::{AabbContext, AnyCollider, Collider, ColliderAabb};
use crate::{
    math::{Scalar, Vector},
    physics_transform::Rotation,
    schedule::{PhysicsSchedule, PhysicsStepSystems},
};

/// The shape of a collider type of the app. Immutable, so that observers see every change.
#[derive(Component, Clone, Debug)]
#[component(immutable)]
pub(crate) struct CustomShape(pub(crate) Shape);

/// Whether a collider type is defined by the app.
pub(crate) fn is_custom<C: AnyCollider>() -> bool {
    TypeId::of::<C>() != TypeId::of::<Collider>()
}

/// Keeps the shapes of a collider type of the app up to date: new colliders at once, changed colliders before
/// each step.
pub(super) fn watch_shapes<C: AnyCollider>(app: &mut App) {
    app.add_observer(shape_added::<C>).add_observer(shape_removed::<C>).add_systems(
        PhysicsSchedule,
        update_shapes::<C>.before(PhysicsStepSystems::First).ambiguous_with_all(),
    );
}

fn shape_removed<C: AnyCollider>(on: On<Remove, C>, mut commands: Commands) {
    commands.entity(on.entity).queue_silenced(|mut entity: EntityWorldMut| {
        // Another collider may have been inserted meanwhile.
        if !entity.contains::<C>() {
            entity.remove::<CustomShape>();
        }
    });
}

fn shape_added<C: AnyCollider>(
    on: On<Insert, C>,
    colliders: Query<&C, Allow<Disabled>>,
    context: StaticSystemParam<C::Context>,
    mut commands: Commands,
) {
    if let Ok(collider) = colliders.get(on.entity) {
        set_box(on.entity, box_of::<C>(on.entity, collider, &context), &mut commands);
    }
}

/// A shape that depends on a context may change while its component does not, so all shapes are checked.
fn update_shapes<C: AnyCollider>(
    colliders: Query<(Entity, Ref<C>, Option<&CustomShape>), Allow<Disabled>>,
    context: StaticSystemParam<C::Context>,
    mut commands: Commands,
) {
    let is_alone = TypeId::of::<C::Context>() == TypeId::of::<()>();
    for (entity, collider, old) in &colliders {
        if is_alone && !collider.is_changed() && old.is_some() {
            continue;
        }
        let new = box_of::<C>(entity, &collider, &context);
        let is_same = match old {
            Some(CustomShape(Shape::Foreign(old))) => old.aabb == new.unwrap_or(POINT),
            _ => false,
        };
        if !is_same || collider.is_changed() {
            set_box(entity, new, &mut commands);
        }
    }
}

/// The box that replaces an invalid one.
const POINT: Aabb = Aabb { min: kernel::math::Vector::ZERO, max: kernel::math::Vector::ZERO };

/// Gives a collider its box. An invalid box gives a warning, and becomes a point.
fn set_box(entity: Entity, aabb: Option<Aabb>, commands: &mut Commands) {
    if aabb.is_none() {
        warn!("the box of the collider {entity} is not valid; it is taken for a point");
    }
    let shape = Foreign { aabb: aabb.unwrap_or(POINT) };
    commands.entity(entity).try_insert(CustomShape(Shape::Foreign(shape)));
}

/// The box of a collider in its own frame, rounded outward, if it is valid.
fn box_of<C: AnyCollider>(
    entity: Entity,
    collider: &C,
    context: &SystemParamItem<C::Context>,
) -> Option<Aabb> {
    let context = AabbContext::new(entity, context);
    let ColliderAabb { min, max } = collider.aabb_with_context(Vector::ZERO, Rotation::default(), context);
    let outward = |corner: Vector, rounded: fn(Scalar) -> f32| {
        kernel::math::Vector::from_array(corner.to_array().map(rounded))
    };
    let aabb = Aabb { min: outward(min, round_down), max: outward(max, round_up) };
    aabb.is_valid().then_some(aabb)
}

/// The nearest `f32` not above `v`.
pub(super) fn round_down(v: Scalar) -> f32 {
    let rounded = v as f32;
    if Scalar::from(rounded) > v { rounded.next_down() } else { rounded }
}

/// The nearest `f32` not below `v`.
pub(super) fn round_up(v: Scalar) -> f32 {
    -round_down(-v)
}
