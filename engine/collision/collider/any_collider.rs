//! The traits of collider types, for custom collider backends.

use super::ColliderAabb;
use crate::collision::contact_types::ContactManifold;
use crate::math::{ComputeMassProperties, Scalar, Vector};
use crate::physics_transform::Rotation;
use bevy_derive::Deref;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::{Component, Entity};
use bevy_ecs::system::{ReadOnlySystemParam, SystemParam};

/// A type that can be converted to a collider of type `C`, such as a geometric primitive of Bevy.
pub trait IntoCollider<C: AnyCollider> {
    /// Makes the collider.
    fn collider(&self) -> C;
}

/// The arguments of [`AnyCollider::aabb_with_context`] besides the collider: its entity, and the system
/// parameter of the collider type.
#[derive(Deref)]
pub struct AabbContext<'a, 'w, 's, T: ReadOnlySystemParam> {
    /// The collider's entity.
    pub entity: Entity,
    #[deref]
    item: &'a <T as SystemParam>::Item<'w, 's>,
}

impl<T: ReadOnlySystemParam> Clone for AabbContext<'_, '_, '_, T> {
    fn clone(&self) -> Self {
        Self { entity: self.entity, item: self.item }
    }
}

impl<'a, 'w, 's, T: ReadOnlySystemParam> AabbContext<'a, 'w, 's, T> {
    /// The context of the collider of `entity`.
    pub fn new(entity: Entity, item: &'a <T as SystemParam>::Item<'w, 's>) -> Self {
        Self { entity, item }
    }
}

impl AabbContext<'_, '_, '_, ()> {
    /// The context of a collider type that needs none.
    fn fake() -> Self {
        Self { entity: Entity::PLACEHOLDER, item: &() }
    }
}

/// The arguments of [`AnyCollider::contact_manifolds_with_context`] besides the colliders: their entities,
/// and the system parameter of the collider type.
#[derive(Deref)]
pub struct ContactManifoldContext<'a, 'w, 's, T: ReadOnlySystemParam> {
    /// The first collider's entity.
    pub entity1: Entity,
    /// The second collider's entity.
    pub entity2: Entity,
    #[deref]
    item: &'a <T as SystemParam>::Item<'w, 's>,
}

impl<'a, 'w, 's, T: ReadOnlySystemParam> ContactManifoldContext<'a, 'w, 's, T> {
    /// The context of the colliders of two entities.
    pub fn new(entity1: Entity, entity2: Entity, item: &'a <T as SystemParam>::Item<'w, 's>) -> Self {
        Self { entity1, entity2, item }
    }
}

impl ContactManifoldContext<'_, '_, '_, ()> {
    /// The context of a collider type that needs none.
    fn fake() -> Self {
        Self { entity1: Entity::PLACEHOLDER, entity2: Entity::PLACEHOLDER, item: &() }
    }
}

/// A component that the engine can use as a collider.
///
/// Collider types that need no other data set `Context = ()` and get [`SimpleCollider`]. Other types name a
/// read-only system parameter, for instance a query for components that their shape depends on.
///
/// A custom type needs a [`ColliderBackendPlugin`](super::ColliderBackendPlugin) and a
/// [`NarrowPhasePlugin`](crate::collision::narrow_phase::NarrowPhasePlugin). Colliders of one type collide
/// with each other, not with colliders of other types. The manifolds of a custom type are computed by one
/// thread, once per step and pair. Spatial queries and sweeps of fast bodies ignore custom types.
///
/// If the shape depends on a context, the engine compares the box of the collider before each step. Report a
/// change that keeps the box by `set_changed` on the collider; otherwise sleeping bodies stay asleep.
pub trait AnyCollider: Component<Mutability = Mutable> + ComputeMassProperties {
    /// The system parameter that the methods need.
    type Context: for<'w, 's> ReadOnlySystemParam<Item<'w, 's>: Send + Sync>;

    /// The box around the collider at a pose in the world.
    fn aabb_with_context(
        &self,
        position: Vector,
        rotation: impl Into<Rotation>,
        context: AabbContext<Self::Context>,
    ) -> ColliderAabb;

    /// The box around the motion of the collider from one pose to another. By default the union of the boxes
    /// at both poses.
    fn swept_aabb_with_context(
        &self,
        start_position: Vector,
        start_rotation: impl Into<Rotation>,
        end_position: Vector,
        end_rotation: impl Into<Rotation>,
        context: AabbContext<Self::Context>,
    ) -> ColliderAabb {
        self.aabb_with_context(start_position, start_rotation, context.clone())
            .merged(self.aabb_with_context(end_position, end_rotation, context))
    }

    /// Replaces `manifolds` by the manifolds of this collider and another one, at poses in the world.
    ///
    /// Normals point from this collider to the other. Points have their
    /// [`point`](crate::prelude::ContactPoint::point) in the world. Include points up to
    /// `prediction_distance` metres apart, with negative penetration: they stop fast bodies.
    #[expect(clippy::too_many_arguments, reason = "as in Avian")]
    fn contact_manifolds_with_context(
        &self,
        other: &Self,
        position1: Vector,
        rotation1: impl Into<Rotation>,
        position2: Vector,
        rotation2: impl Into<Rotation>,
        prediction_distance: Scalar,
        manifolds: &mut Vec<ContactManifold>,
        context: ContactManifoldContext<Self::Context>,
    );
}

/// The methods of [`AnyCollider`] for colliders that need no context.
pub trait SimpleCollider: AnyCollider<Context = ()> {
    /// The box around the collider at a pose in the world.
    fn aabb(&self, position: Vector, rotation: impl Into<Rotation>) -> ColliderAabb {
        self.aabb_with_context(position, rotation, AabbContext::fake())
    }

    /// The box around the motion of the collider from one pose to another.
    fn swept_aabb(
        &self,
        start_position: Vector,
        start_rotation: impl Into<Rotation>,
        end_position: Vector,
        end_rotation: impl Into<Rotation>,
    ) -> ColliderAabb {
        self.swept_aabb_with_context(
            start_position,
            start_rotation,
            end_position,
            end_rotation,
            AabbContext::fake(),
        )
    }

    /// Replaces `manifolds` by the manifolds of this collider and another one, at poses in the world, with
    /// points up to `prediction_distance` metres apart.
    #[expect(clippy::too_many_arguments, reason = "as in Avian")]
    fn contact_manifolds(
        &self,
        other: &Self,
        position1: Vector,
        rotation1: impl Into<Rotation>,
        position2: Vector,
        rotation2: impl Into<Rotation>,
        prediction_distance: Scalar,
        manifolds: &mut Vec<ContactManifold>,
    ) {
        self.contact_manifolds_with_context(
            other,
            position1,
            rotation1,
            position2,
            rotation2,
            prediction_distance,
            manifolds,
            ContactManifoldContext::fake(),
        );
    }
}

impl<C: AnyCollider<Context = ()>> SimpleCollider for C {}

/// A collider that can be scaled.
pub trait ScalableCollider: AnyCollider {
    /// The scale along each axis.
    fn scale(&self) -> Vector;

    /// Sets the scale. `detail` is the number of subdivisions for curved shapes that become polygonal.
    fn set_scale(&mut self, scale: Vector, detail: u32);

    /// Multiplies the scale.
    fn scale_by(&mut self, factor: Vector, detail: u32) {
        self.set_scale(factor * self.scale(), detail);
    }
}
