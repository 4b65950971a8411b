//! Components of mass properties: set by the app, of colliders, and computed by the engine.

mod bundle;
mod collider;
mod computed;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;

pub use bundle::MassPropertiesBundle;
pub use collider::{ColliderDensity, ColliderMassProperties};
pub use computed::{ComputedCenterOfMass, ComputedMass};
pub use dim::{AngularInertia, ComputedAngularInertia};

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::{lifecycle::HookContext, prelude::*, world::DeferredWorld};
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

use crate::math::{ComputeMassProperties, VectorF32};

/// The reason why a number is not a valid mass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MassError {
    /// The number is negative.
    #[error("a mass is not negative")]
    Negative,
    /// The number is NaN.
    #[error("a mass is not NaN")]
    NaN,
}

/// The reason why a number, or in 3D one of three numbers, is not a valid angular inertia.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AngularInertiaError {
    /// The number is negative.
    #[error("an angular inertia is not negative")]
    Negative,
    /// The number is NaN.
    #[error("an angular inertia is not NaN")]
    NaN,
}

/// The mass of a body, or of a part of the body on a descendant, in kg.
///
/// It replaces the mass of the collider on the same entity. Without an [`AngularInertia`] the collider's
/// inertia is scaled in proportion. The body's total, [`ComputedMass`], is the sum over the body and its
/// descendants. With [`NoAutoMass`] it is only the body's own mass. Infinity is allowed. Negative values and
/// NaN count as 0, with a warning.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn spawn(mut commands: Commands) {
///     // 7 kg in all.
///     commands.spawn((RigidBody::Dynamic, Mass(5.0))).with_child(Mass(2.0));
///     // 5 kg, without descendants.
///     commands.spawn((RigidBody::Dynamic, Mass(5.0), NoAutoMass)).with_child(Mass(2.0));
/// }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct Mass(pub f32);

impl Mass {
    /// No mass.
    pub const ZERO: Self = Self(0.0);

    /// The mass of a shape filled with a material of `density`, in kg/m³ (in 2D kg/m²).
    pub fn from_shape<T: ComputeMassProperties>(shape: &T, density: f32) -> Self {
        Self(shape.mass(density))
    }
}

/// The centre of mass of a body, or of a part of the body on a descendant, in the entity's frame, in metres.
///
/// It replaces the centre of the collider on the same entity. The body's total, [`ComputedCenterOfMass`], is
/// the mean over the body and its descendants, weighted by mass. With [`NoAutoCenterOfMass`] it is only the
/// body's own centre of mass.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct CenterOfMass(pub VectorF32);

impl CenterOfMass {
    /// The entity's origin.
    pub const ZERO: Self = Self(VectorF32::ZERO);

    /// The centroid of a shape.
    pub fn from_shape<T: ComputeMassProperties>(shape: &T) -> Self {
        Self(shape.center_of_mass())
    }
}

/// Restricts a body's total mass to its own [`Mass`], without colliders and descendants. Without a `Mass` the
/// app sets [`ComputedMass`] itself.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Debug, Default, PartialEq)]
#[require(RecomputeMassProperties)]
#[component(on_remove = on_remove_no_auto)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct NoAutoMass;

/// Restricts a body's total angular inertia to its own [`AngularInertia`], without colliders and descendants.
/// Without an `AngularInertia` the app sets [`ComputedAngularInertia`] itself.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Debug, Default, PartialEq)]
#[require(RecomputeMassProperties)]
#[component(on_remove = on_remove_no_auto)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct NoAutoAngularInertia;

/// Restricts a body's centre of mass to its own [`CenterOfMass`], without colliders and descendants. Without
/// a `CenterOfMass` the app sets [`ComputedCenterOfMass`] itself.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Debug, Default, PartialEq)]
#[require(RecomputeMassProperties)]
#[component(on_remove = on_remove_no_auto)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct NoAutoCenterOfMass;

/// Marks a body for recomputation of its mass properties before the next step, which removes the marker.
///
/// The engine inserts it when it detects a change. See [`MassPropertyPlugin`](super::MassPropertyPlugin) for
/// changes that it does not detect.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Component, Debug, Default, PartialEq)]
#[component(storage = "SparseSet")]
pub struct RecomputeMassProperties;

fn on_remove_no_auto(mut world: DeferredWorld, context: HookContext) {
    world.commands().entity(context.entity).try_insert(RecomputeMassProperties);
}
