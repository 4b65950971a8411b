//! Colliders: the shapes of bodies for contacts and queries, and their components.
//!
//! [`Collider`] is the default type; any component can be a collider through [`AnyCollider`].

mod aabb;
#[cfg(not(feature = "default-collider"))]
mod absent;
mod any_collider;
mod backend;
#[cfg(all(feature = "collider-from-mesh", feature = "default-collider"))]
mod cache;
pub mod collider_hierarchy;
pub mod collider_transform;
#[cfg(feature = "default-collider")]
pub mod constructor;
pub(crate) mod custom;
mod layers;
#[cfg(feature = "default-collider")]
mod parry;
mod scale;

pub use aabb::{ColliderAabb, EnlargedAabb};
#[cfg(not(feature = "default-collider"))]
pub(crate) use absent::{Collider, foreign_ball_manifolds, foreign_manifolds};
pub use any_collider::{
    AabbContext, AnyCollider, ContactManifoldContext, IntoCollider, ScalableCollider, SimpleCollider,
};
pub use backend::{ColliderBackendPlugin, update_collider_mass_properties};
#[cfg(all(feature = "collider-from-mesh", feature = "default-collider"))]
pub use cache::ColliderCachePlugin;
#[cfg(feature = "default-collider")]
#[doc(inline)]
pub use constructor::*;
pub use layers::*;
#[cfg(feature = "default-collider")]
pub use parry::*;
pub use scale::update_collider_scale;

use crate::math::Scalar;
use bevy_derive::{Deref, DerefMut};
use bevy_ecs::entity::{EntityHashSet, EntityMapper, MapEntities};
use bevy_ecs::prelude::Component;
use bevy_ecs::reflect::ReflectComponent;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

/// Marks an entity with a collider of any type. Added by the engine.
#[derive(Reflect, Component, Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default)]
pub struct ColliderMarker;

crate::type_path::type_path!(ColliderMarker, "collision::collider::backend");

/// Takes a collider out of the simulation: no contacts, no query results, no mass.
#[derive(Reflect, Clone, Copy, Component, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default)]
pub struct ColliderDisabled;

/// Makes a collider a sensor: it detects contacts, but does not collide and has no mass.
///
/// A sensor detects the colliders of dynamic and kinematic bodies. A sensor on such a body detects static
/// colliders as well. A sensor without a body detects other colliders without a body, but not static
/// floors and walls.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # fn setup(mut commands: Commands) {
/// // A region that bodies pass through.
/// commands.spawn((RigidBody::Static, Collider::capsule(2.0, 4.0), Sensor));
/// # }
/// ```
#[derive(Reflect, Clone, Component, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
#[doc(alias = "Trigger")]
pub struct Sensor;

/// The colliders that a collider touches, sensors included. Insert it on a collider; the engine updates it at
/// the end of each step, before collision events are sent. Despawned colliders are removed at once.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn print(touched: Query<(Entity, &CollidingEntities)>) {
///     for (collider, others) in &touched {
///         println!("{collider} touches {} others", others.len());
///     }
/// }
/// ```
#[derive(Reflect, Clone, Component, Debug, Default, Deref, DerefMut, PartialEq, Eq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
pub struct CollidingEntities(pub EntityHashSet);

impl MapEntities for CollidingEntities {
    fn map_entities<M: EntityMapper>(&mut self, mapper: &mut M) {
        self.0 = self.0.drain().map(|entity| mapper.get_mapped(entity)).collect();
    }
}

/// The distance kept between the surface of a collider and other colliders, in metres.
///
/// A small margin makes thin and jagged shapes more robust, at the cost of a visible gap. A collider without
/// the component has the margin of its body, or none.
#[derive(Reflect, Clone, Copy, Component, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
#[doc(alias = "CollisionSkin")]
pub struct CollisionMargin(pub Scalar);
