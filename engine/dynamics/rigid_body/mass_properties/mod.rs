//! What bodies weigh: mass, angular inertia and centre of mass, from shapes, from the user, or both.
//!
//! A body's totals are [`ComputedMass`], [`ComputedAngularInertia`] and [`ComputedCenterOfMass`]. They are the
//! sum over
//!
//! - the body itself: its collider, if it has one, with [`Mass`], [`AngularInertia`] and [`CenterOfMass`] in
//!   place of what the collider says;
//! - each of its colliders on other entities, where its `ColliderTransform` puts it, with the same components
//!   in place of what the collider says;
//! - each of its descendants that is no collider but has one of the three components, where its `Transform`
//!   puts it. What belongs to a descendant that is a body itself does not count.
//!
//! Sensors and disabled colliders weigh nothing. [`NoAutoMass`] and its siblings restrict a total to the body's
//! own component. A mass without an inertia scales the inertia of the collider; a centre of mass moves the
//! inertia along unchanged.
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

/// Makes components of `bevy_heavy`'s mass properties.
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

/// What computes mass properties, in this order, within
/// [`PhysicsSystems::Prepare`](crate::schedule::PhysicsSystems::Prepare).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MassPropertySystems {
    /// The mass properties of new and changed colliders.
    UpdateColliderMassProperties,
    /// Which bodies have to be computed again.
    QueueRecomputation,
    /// The totals of those bodies.
    UpdateComputedMassProperties,
}

/// Filters for entities with any of the computed mass properties.
pub type WithComputedMassProperty =
    Or<(With<ComputedMass>, With<ComputedAngularInertia>, With<ComputedCenterOfMass>)>;

/// Filters for entities of which the user changed any of the mass properties.
pub type MassPropertyChanged = Or<(Changed<Mass>, Changed<AngularInertia>, Changed<CenterOfMass>)>;
