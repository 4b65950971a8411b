//! Collider types of the app in the tables: as boxes, whose contacts the type itself computes.

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

/// The shape of a collider of a type of the app. Immutable, so that observers see every change.
#[derive(Component, Clone, Debug)]
#[component(immutable)]
pub(crate) struct CustomShape(pub(crate) Shape);

/// Whether a collider type is one of the app.
pub(crate) fn is_custom<C: AnyCollider>() -> bool {
    TypeId::of::<C>() != TypeId::of::<Collider>()
}

/// Keeps the shapes of a collider type of the app up to date: of new colliders at once, of changed ones before each step.
pub(super) fn watch_shapes<C: AnyCollider>(app: &mut App) {
    app.add_observer(shape_added::<C>)
        .add_observer(|on: On<Remove, C>, mut commands: Commands| {
            commands.entity(on.entity).try_remove::<CustomShape>();
        })
        .add_systems(
            PhysicsSchedule,
            update_shapes::<C>.before(PhysicsStepSystems::First).ambiguous_with_all(),
        );
}

fn shape_added<C: AnyCollider>(
    on: On<Insert, C>,
    colliders: Query<&C, Allow<Disabled>>,
    context: StaticSystemParam<C::Context>,
    mut commands: Commands,
) {
    if let Ok(collider) = colliders.get(on.entity) {
        let shape = box_of::<C>(on.entity, collider, &context);
        commands.entity(on.entity).try_insert(CustomShape(Shape::Foreign(shape)));
    }
}

/// Shapes that depend on a context may change without their component, so all of them are looked at.
fn update_shapes<C: AnyCollider>(
    colliders: Query<(Entity, Ref<C>, &CustomShape), Allow<Disabled>>,
    context: StaticSystemParam<C::Context>,
    mut commands: Commands,
) {
    let is_alone = TypeId::of::<C::Context>() == TypeId::of::<()>();
    for (entity, collider, CustomShape(old)) in &colliders {
        if is_alone && !collider.is_changed() {
            continue;
        }
        let new = Shape::Foreign(box_of::<C>(entity, &collider, &context));
        let is_new = match (old, &new) {
            (Shape::Foreign(old), Shape::Foreign(new)) => old.aabb != new.aabb,
            _ => true,
        };
        if is_new || collider.is_changed() {
            commands.entity(entity).try_insert(CustomShape(new));
        }
    }
}

/// The box of a collider in its own frame, rounded outward. An invalid one is warned of, and becomes a point.
fn box_of<C: AnyCollider>(entity: Entity, collider: &C, context: &SystemParamItem<C::Context>) -> Foreign {
    let context = AabbContext::new(entity, context);
    let ColliderAabb { min, max } = collider.aabb_with_context(Vector::ZERO, Rotation::default(), context);
    let outward = |corner: Vector, rounded: fn(Scalar) -> f32| {
        kernel::math::Vector::from_array(corner.to_array().map(rounded))
    };
    let aabb = Aabb { min: outward(min, round_down), max: outward(max, round_up) };
    if aabb.is_valid() {
        return Foreign { aabb };
    }
    warn!("the box of the collider {entity} is not valid: {min} to {max}; it touches nothing");
    Foreign { aabb: Aabb::around([kernel::math::Vector::ZERO]) }
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
