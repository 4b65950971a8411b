//! Mass properties of bodies: mass, angular inertia and centre of mass, from shapes, from the app, or from
//! both.
//!
//! A body's totals are [`ComputedMass`], [`ComputedAngularInertia`] and [`ComputedCenterOfMass`]. They
//! are the sum over
//!
//! - the body itself: its collider, if it has one, with values replaced by its [`Mass`], [`AngularInertia`]
//!   and [`CenterOfMass`];
//! - each of its colliders on other entities, at its `ColliderTransform`, with values replaced by the
//!   same components;
//! - each descendant without a collider that has one of the three components, at its `Transform`. A
//!   descendant that is a body does not count, and neither does anything below it.
//!
//! Sensors and disabled colliders have no mass. [`NoAutoMass`] and its siblings restrict a total to the
//! body's own component. A mass without an inertia scales the inertia of the collider. A centre of mass moves
//! the inertia without changing it.
//!
//! ```
//! # use avian::prelude::*;
//! # use bevy_ecs::prelude::*;
//! fn spawn(mut commands: Commands) {
//!     commands
//!         .spawn((RigidBody::Dynamic, Mass(3.0)))
//!         // A weight that keeps the body upright.
//!         .with_child((Mass(1.0), CenterOfMass::ZERO));
//! }
//! ```
//!
//! [`ComputedMass`]: components::ComputedMass
//! [`ComputedAngularInertia`]: components::ComputedAngularInertia
//! [`ComputedCenterOfMass`]: components::ComputedCenterOfMass
//! [`Mass`]: components::Mass
//! [`AngularInertia`]: components::AngularInertia
//! [`CenterOfMass`]: components::CenterOfMass
//! [`NoAutoMass`]: components::NoAutoMass

pub mod components;
#[cfg(feature = "3d")]
mod eigen;
mod inertia;
mod plugin;
pub(crate) mod queue;
mod system_param;
#[cfg(feature = "3d")]
mod tensor;
#[cfg(test)]
mod tests;

pub use bevy_heavy;
pub use plugin::MassPropertyPlugin;
pub(crate) use queue::MassPropertyQueue;
pub use system_param::MassPropertyHelper;

use bevy_ecs::prelude::*;

use self::components::{
    AngularInertia, CenterOfMass, ComputedAngularInertia, ComputedCenterOfMass, ComputedMass, Mass,
    MassPropertiesBundle,
};
use crate::math::MassProperties;

/// Conversion of `bevy_heavy`'s mass properties to components.
pub trait MassPropertiesExt {
    /// The same mass, inertia and centre as components to spawn.
    fn to_bundle(&self) -> MassPropertiesBundle;
}

impl MassPropertiesExt for MassProperties {
    fn to_bundle(&self) -> MassPropertiesBundle {
        MassPropertiesBundle {
            mass: Mass(self.mass),
            angular_inertia: AngularInertia::from(self),
            center_of_mass: CenterOfMass(self.center_of_mass),
        }
    }
}

/// System sets of mass properties, in this order, within
/// [`PhysicsSystems::Prepare`](crate::schedule::PhysicsSystems::Prepare).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MassPropertySystems {
    /// Compute the mass properties of new and changed colliders.
    UpdateColliderMassProperties,
    /// Mark bodies to be computed again.
    QueueRecomputation,
    /// Compute the totals of marked bodies.
    UpdateComputedMassProperties,
}

/// Filters for entities with any of the computed mass properties.
pub type WithComputedMassProperty =
    Or<(With<ComputedMass>, With<ComputedAngularInertia>, With<ComputedCenterOfMass>)>;

/// Filters for entities whose mass properties the app changed.
pub type MassPropertyChanged = Or<(Changed<Mass>, Changed<AngularInertia>, Changed<CenterOfMass>)>;
