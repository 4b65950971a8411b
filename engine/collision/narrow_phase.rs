//! The narrow phase: where the boxes of two colliders overlap, their shapes are compared and contact points computed.

use bevy_app::{App, Plugin};
use bevy_ecs::{intern::Interned, prelude::*, schedule::ScheduleLabel};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::marker::PhantomData;

use super::{
    collider::AnyCollider,
    contacts::{NarrowScratch, link_contacts, update_contacts},
    diagnostics::{CollisionDiagnostics, reset_collision},
};
use crate::{
    dynamics::{
        materials::refresh_surfaces,
        rigid_body::{DefaultFriction, DefaultRestitution},
        solver::PhysicsLengthUnit,
    },
    math::Scalar,
    schedule::{PhysicsSchedule, PhysicsStepSystems},
    step::{self, Stage},
};

/// Computes the contacts between colliders of type `C`, one instance per type.
pub struct NarrowPhasePlugin<C: AnyCollider, H = ()> {
    schedule: Interned<dyn ScheduleLabel>,
    generate_constraints: bool,
    backend: PhantomData<fn() -> (C, H)>,
}

impl<C: AnyCollider, H> NarrowPhasePlugin<C, H> {
    /// Computes contacts in `schedule`, by default [`PhysicsSchedule`], and, unless `generate_constraints` is false, hands them to the solver.
    pub fn new(schedule: impl ScheduleLabel, generate_constraints: bool) -> Self {
        Self { schedule: schedule.intern(), generate_constraints, backend: PhantomData }
    }
}

impl<C: AnyCollider, H> Default for NarrowPhasePlugin<C, H> {
    fn default() -> Self {
        Self::new(PhysicsSchedule, true)
    }
}

impl<C: AnyCollider, H: 'static> Plugin for NarrowPhasePlugin<C, H> {
    fn build(&self, app: &mut App) {
        app.init_resource::<NarrowPhaseConfig>()
            .init_resource::<DefaultFriction>()
            .init_resource::<DefaultRestitution>()
            .init_resource::<NarrowScratch>()
            .init_resource::<CollisionDiagnostics>()
            .init_resource::<PhysicsLengthUnit>()
            .insert_resource(ContactResponse(self.generate_constraints));
        step::install(app);
        app.add_systems(
            self.schedule,
            (
                reset_collision.in_set(Stage::ResetDiagnostics),
                refresh_surfaces.in_set(Stage::RefreshSurfaces),
                update_contacts.in_set(Stage::UpdateContacts),
                link_contacts.in_set(Stage::LinkContacts),
            ),
        );

        app.configure_sets(
            self.schedule,
            (
                (NarrowPhaseSystems::First, NarrowPhaseSystems::Update, NarrowPhaseSystems::Last)
                    .chain()
                    .in_set(PhysicsStepSystems::NarrowPhase),
                CollisionEventSystems.in_set(PhysicsStepSystems::Finalize),
            ),
        );
    }
}

/// Whether contacts push: false leaves detection and events, without a response.
#[derive(Resource, Clone, Copy, Debug)]
pub(crate) struct ContactResponse(pub(crate) bool);

/// Where collision events are sent, in [`PhysicsStepSystems::Finalize`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CollisionEventSystems;

/// How contacts are computed.
#[derive(Resource, Reflect, Clone, Debug, PartialEq)]
#[reflect(Debug, Resource, Default, PartialEq)]
pub struct NarrowPhaseConfig {
    /// The [`SpeculativeMargin`](crate::dynamics::ccd::SpeculativeMargin) of colliders and bodies without one, in metres. Unbounded by default.
    pub default_speculative_margin: Scalar,
    /// How far apart two shapes at rest may be and still be in contact, times
    /// [`PhysicsLengthUnit`]; 0.005 by default. At 0 resting contacts flicker.
    pub contact_tolerance: Scalar,
    /// Whether contact points take over the impulses of the points they were in the last step; true by default. Without, stacks sag.
    pub match_contacts: bool,
}

impl Default for NarrowPhaseConfig {
    fn default() -> Self {
        Self { default_speculative_margin: Scalar::MAX, contact_tolerance: 0.005, match_contacts: true }
    }
}

/// The stages of the narrow phase, in this order, in [`PhysicsStepSystems::NarrowPhase`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NarrowPhaseSystems {
    /// Before contacts are computed.
    First,
    /// Contacts are computed.
    Update,
    /// After it.
    Last,
}

/// The former name of [`NarrowPhaseSystems`].
#[deprecated(since = "0.4.0", note = "renamed to `NarrowPhaseSystems`")]
pub type NarrowPhaseSet = NarrowPhaseSystems;
