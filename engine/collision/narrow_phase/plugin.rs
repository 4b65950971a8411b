//! The plugin that computes contacts.

use bevy_app::{App, Plugin};
use bevy_ecs::{intern::Interned, prelude::*, schedule::ScheduleLabel, system::SystemParamItem};
use core::{any::TypeId, marker::PhantomData};

use super::{CollisionEventSystems, ContactResponse, NarrowPhaseConfig, NarrowPhaseSystems};
use crate::{
    collision::{
        collider::{AnyCollider, custom::is_custom},
        collision_events::{CollisionEnd, CollisionStart},
        collision_hits::CollisionHit,
        contacts::{NarrowPhaseBuffers, update_contacts},
        custom_contacts::find_custom_contacts,
        diagnostics::CollisionDiagnostics,
        hooks::{CollisionHooks, modify_contacts},
    },
    diagnostics::{Within, list},
    dynamics::{
        materials::watch_surfaces,
        rigid_body::{DefaultFriction, DefaultRestitution},
        solver::config::PhysicsLengthUnit,
    },
    schedule::{PhysicsSchedule, PhysicsStepSystems},
    step::{self, Owner, Stage},
};

/// Computes the contacts between colliders of type `C`. Add one instance per collider type. All instances
/// share the settings of the first.
///
/// `H` are the [`CollisionHooks`] that change contacts.
pub struct NarrowPhasePlugin<C: AnyCollider, H: CollisionHooks = ()> {
    shared: SharedNarrowPhasePlugin,
    backend: PhantomData<fn() -> (C, H)>,
}

/// Adds the system sets and systems, once for all collider types.
#[derive(Clone, Copy)]
struct SharedNarrowPhasePlugin {
    schedule: Interned<dyn ScheduleLabel>,
    generate_constraints: bool,
}

impl<C: AnyCollider, H: CollisionHooks> NarrowPhasePlugin<C, H> {
    /// Computes contacts in `schedule`, by default [`PhysicsSchedule`]. If `generate_constraints` is false,
    /// they are not solved.
    pub fn new(schedule: impl ScheduleLabel, generate_constraints: bool) -> Self {
        let shared = SharedNarrowPhasePlugin { schedule: schedule.intern(), generate_constraints };
        Self { shared, backend: PhantomData }
    }
}

impl<C: AnyCollider, H: CollisionHooks> Default for NarrowPhasePlugin<C, H> {
    fn default() -> Self {
        Self::new(PhysicsSchedule, true)
    }
}

impl<C: AnyCollider, H: CollisionHooks + 'static> Plugin for NarrowPhasePlugin<C, H>
where
    for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
{
    fn build(&self, app: &mut App) {
        step::add_once(app, self.shared);
        if is_custom::<C>() && !app.is_plugin_added::<CustomPlugin<C>>() {
            app.add_plugins(CustomPlugin::<C> { schedule: self.shared.schedule, collider: PhantomData });
        }
        if TypeId::of::<H>() != TypeId::of::<()>() {
            step::add_once(app, HooksPlugin::<H> { schedule: self.shared.schedule, hooks: PhantomData });
        }
    }
}

/// Computes the contacts of a collider type of the app, once for all instances of its plugin.
struct CustomPlugin<C> {
    schedule: Interned<dyn ScheduleLabel>,
    collider: PhantomData<fn() -> C>,
}

impl<C: AnyCollider> Plugin for CustomPlugin<C> {
    fn build(&self, app: &mut App) {
        let find = find_custom_contacts::<C>.in_set(Stage::UpdateContacts).before(update_contacts);
        step::add_systems(app, self.schedule, find);
    }
}

/// Adds the hooks that change contacts, once for all collider types.
struct HooksPlugin<H> {
    schedule: Interned<dyn ScheduleLabel>,
    hooks: PhantomData<fn() -> H>,
}

impl<H: CollisionHooks + 'static> Plugin for HooksPlugin<H>
where
    for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
{
    fn build(&self, app: &mut App) {
        let modify = modify_contacts::<H>.in_set(Stage::UpdateContacts).after(update_contacts);
        step::add_systems(app, self.schedule, modify);
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
            .add_message::<CollisionHit>()
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
