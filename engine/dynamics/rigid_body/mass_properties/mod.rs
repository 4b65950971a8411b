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
mod queue;
mod system_param;
#[cfg(test)]
mod tests;

pub use bevy_heavy;
pub(crate) use queue::MassPropertyQueue;
pub use system_param::MassPropertyHelper;

use bevy_app::{FixedPostUpdate, prelude::*};
use bevy_ecs::{intern::Interned, prelude::*, schedule::ScheduleLabel};

use self::components::{
    AngularInertia, CenterOfMass, ComputedAngularInertia, ComputedCenterOfMass, ComputedMass, Mass,
    MassPropertiesBundle,
};
use crate::{math::MassProperties, physics_transform::PhysicsTransformSystems, schedule::PhysicsSystems};

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

/// Keeps the computed mass properties of bodies up to date. Part of `PhysicsPlugins`.
///
/// A body is computed when it carries [`RecomputeMassProperties`](components::RecomputeMassProperties), never
/// otherwise, so that resting worlds cost nothing. The marker is inserted when the body is spawned or changes
/// type; when one of its colliders comes, goes, changes shape or density, becomes a sensor, is disabled or is
/// moved within the body; when one of the components named in the [module](self) comes, goes or changes, on the
/// body or on a descendant. What goes unseen is a change of place of a descendant *without collider* that comes
/// from an entity between it and the body: insert the marker then.
pub struct MassPropertyPlugin {
    schedule: Interned<dyn ScheduleLabel>,
}

impl MassPropertyPlugin {
    /// Computes in `schedule`, in which physics runs; [`FixedPostUpdate`] by default.
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern() }
    }
}

impl Default for MassPropertyPlugin {
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl Plugin for MassPropertyPlugin {
    fn build(&self, app: &mut App) {
        queue::observe(app);
        app.configure_sets(
            self.schedule,
            (
                MassPropertySystems::UpdateColliderMassProperties,
                MassPropertySystems::QueueRecomputation,
                MassPropertySystems::UpdateComputedMassProperties,
            )
                .chain()
                .in_set(PhysicsSystems::Prepare)
                .after(PhysicsTransformSystems::TransformToPosition),
        );
        app.add_systems(
            self.schedule,
            (
                queue::queue_changed.in_set(MassPropertySystems::QueueRecomputation),
                (queue::recompute, queue::warn_of_missing_mass)
                    .chain()
                    .in_set(MassPropertySystems::UpdateComputedMassProperties),
            ),
        );
    }
}

/// What computes mass properties, in this order, within [`PhysicsSystems::Prepare`].
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
