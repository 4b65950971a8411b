//! The plugin that computes contacts.

use bevy_app::{App, Plugin};
use bevy_ecs::{intern::Interned, prelude::*, schedule::ScheduleLabel};
use core::marker::PhantomData;

use super::{CollisionEventSystems, ContactResponse, NarrowPhaseConfig, NarrowPhaseSystems};
use crate::{
    collision::{
        collider::AnyCollider,
        collision_events::{CollisionEnd, CollisionStart},
        contacts::NarrowPhaseBuffers,
        diagnostics::CollisionDiagnostics,
    },
    diagnostics::{Within, list},
    dynamics::{
        materials::watch_surfaces,
        rigid_body::{DefaultFriction, DefaultRestitution},
        solver::config::PhysicsLengthUnit,
    },
    schedule::{PhysicsSchedule, PhysicsStepSystems},
    step::{self, Owner},
};

/// Computes the contacts between colliders of type `C`. Add one instance per collider type. All instances share the
/// settings of the first.
///
/// `H` is reserved for the app's collision hooks. It has no effect yet.
pub struct NarrowPhasePlugin<C: AnyCollider, H = ()> {
    shared: SharedNarrowPhasePlugin,
    backend: PhantomData<fn() -> (C, H)>,
}

/// Adds the system sets and systems, once for all collider types.
#[derive(Clone, Copy)]
struct SharedNarrowPhasePlugin {
    schedule: Interned<dyn ScheduleLabel>,
    generate_constraints: bool,
}

impl<C: AnyCollider, H> NarrowPhasePlugin<C, H> {
    /// Computes contacts in `schedule`, by default [`PhysicsSchedule`]. If `generate_constraints` is false, they are
    /// not solved.
    pub fn new(schedule: impl ScheduleLabel, generate_constraints: bool) -> Self {
        let shared = SharedNarrowPhasePlugin { schedule: schedule.intern(), generate_constraints };
        Self { shared, backend: PhantomData }
    }
}

impl<C: AnyCollider, H> Default for NarrowPhasePlugin<C, H> {
    fn default() -> Self {
        Self::new(PhysicsSchedule, true)
    }
}

impl<C: AnyCollider, H: 'static> Plugin for NarrowPhasePlugin<C, H> {
    fn build(&self, app: &mut App) {
        step::add_once(app, self.shared);
    }
}

impl Plugin for SharedNarrowPhasePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<NarrowPhaseConfig>()
            .init_resource::<DefaultFriction>()
            .init_resource::<DefaultRestitution>()
            .init_resource::<NarrowPhaseBuffers>()
            .init_resource::<PhysicsLengthUnit>()
            .add_message::<CollisionStart>()
            .add_message::<CollisionEnd>()
            .insert_resource(ContactResponse(self.generate_constraints));
        list::<CollisionDiagnostics>(app, Within::Step);
        step::install(app);
        watch_surfaces(app);
        step::add_systems_of(Owner::NarrowPhase, app, self.schedule);

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
