//! The step: every system of the engine in [`PhysicsSchedule`], in the order it runs.
//!
//! Plugins add the systems to the stages below, so that disabling a plugin takes its systems out; this list
//! says where each stage stands. The public sets are attached to the same list, so they cannot drift apart.

use bevy_app::{App, Plugin};
use bevy_ecs::{prelude::*, schedule::ScheduleLabel, system::ScheduleSystem};

use crate::{
    collider_tree::ColliderTreeSystems,
    collision::{
        broad_phase::BroadPhaseSystems,
        narrow_phase::{NarrowPhaseConfig, NarrowPhaseSystems},
    },
    dynamics::{
        integrator::IntegrationSystems,
        lifecycle,
        rigid_body::{DefaultFriction, DefaultRestitution},
        solver::{
            schedule::{SolverSystems, SubstepSolverSystems},
            substeps::{StepSolver, call_team},
            workers::{RowWidth, WorkerCount},
        },
        tables::{Bodies, Colliders, Contacts},
    },
    schedule::{PhysicsSchedule, PhysicsStepSystems, StepTimes},
    threads::Threads,
};

macro_rules! stages {
    ($($(#[$doc:meta])* $stage:ident,)+) => {
        /// The stages of a step, in order.
        #[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub(crate) enum Stage {
            $($(#[$doc])* $stage,)+
        }

        impl Stage {
            /// All of them, with their names.
            const ALL: &[(Self, &str)] = &[$((Self::$stage, stringify!($stage))),+];
        }
    };
}

stages! {
    /// Counters and timers start anew.
    ResetDiagnostics,
    /// Bodies and colliders enter and leave.
    DrainLifecycle,
    /// Surfaces follow their components.
    RefreshSurfaces,
    /// Islands fall asleep and wake as the app asked.
    FollowSleep,
    /// What the app moved or pushed wakes.
    FollowApp,
    /// Poses and velocities of awake bodies are read.
    ReadAwake,
    /// Boxes of what entered or was moved by hand.
    UpdateBoxes,
    /// New pairs become contacts.
    FindPairs,
    /// Manifolds of awake contacts.
    UpdateContacts,
    /// Colours, islands, waking.
    LinkContacts,
    /// Awake bodies become rows.
    Gather,
    /// Touching manifolds become rows.
    PrepareRows,
    /// The substeps.
    Substeps,
    /// What hit fast bounces.
    Restitution,
    /// What bodies did in the substeps is folded into their poses.
    FinishBodies,
    /// Poses and velocities become components.
    Scatter,
    /// Impulses go back into the manifolds.
    StoreImpulses,
    /// Islands at rest fall asleep.
    Sleep,
    /// Boxes of what moved.
    Refit,
    /// What was despawned during the step leaves.
    RemoveLost,
    /// [`Sleeping`](crate::dynamics::rigid_body::sleeping::Sleeping) follows.
    MirrorSleep,
}

/// Adds systems of the engine to [`PhysicsSchedule`] or one that takes its place.
///
/// The stages fix their order, and systems of one stage are chained or share nothing. The order between them and the
/// app's systems in the public sets is left open, and that is no error: such a system sees what was there before or
/// after a stage of its set, and what it writes counts where it is read next.
pub(crate) fn add_systems<M>(
    app: &mut App,
    schedule: impl ScheduleLabel,
    systems: impl IntoScheduleConfigs<ScheduleSystem, M>,
) {
    #[cfg(test)]
    if app.world().contains_resource::<Strict>() {
        app.add_systems(schedule, systems);
        return;
    }
    app.add_systems(schedule, systems.ambiguous_with_all());
}

/// Puts the stages in order and makes the tables. Every plugin that adds to the step calls it; the first call
/// counts.
pub(crate) fn install(app: &mut App) {
    if app.world().contains_resource::<Bodies>() {
        return;
    }
    app.init_resource::<Bodies>()
        .init_resource::<Colliders>()
        .init_resource::<Contacts>()
        .init_resource::<StepSolver>()
        .init_resource::<WorkerCount>()
        .init_resource::<RowWidth>()
        .init_resource::<StepTimes>()
        .init_resource::<Threads>()
        // Colliders have a surface whether or not the narrow phase is there to use it.
        .init_resource::<DefaultFriction>()
        .init_resource::<DefaultRestitution>()
        .init_resource::<NarrowPhaseConfig>();
    lifecycle::watch(app);
    app.configure_sets(
        PhysicsSchedule,
        (
            (
                Stage::ResetDiagnostics,
                Stage::DrainLifecycle,
                Stage::RefreshSurfaces,
                Stage::FollowSleep,
                Stage::FollowApp,
                Stage::ReadAwake,
            )
                .chain()
                .in_set(PhysicsStepSystems::First),
            Stage::UpdateBoxes.in_set(ColliderTreeSystems::UpdateAabbs),
            Stage::FindPairs.in_set(BroadPhaseSystems::CollectCollisions),
            (Stage::UpdateContacts, Stage::LinkContacts).chain().in_set(NarrowPhaseSystems::Update),
            Stage::Gather.in_set(SolverSystems::PrepareSolverBodies),
            Stage::PrepareRows.in_set(SolverSystems::PrepareContactConstraints),
            Stage::Substeps.in_set(SolverSystems::Substep),
            Stage::Restitution.in_set(SolverSystems::Restitution),
            (Stage::FinishBodies, Stage::Scatter).chain().in_set(SolverSystems::Finalize),
            Stage::StoreImpulses.in_set(SolverSystems::StoreContactImpulses),
            Stage::Sleep.in_set(PhysicsStepSystems::Sleeping),
            (Stage::Refit, Stage::RemoveLost, Stage::MirrorSleep)
                .chain()
                .in_set(PhysicsStepSystems::Finalize),
        )
            .chain(),
    );
    add_systems(
        app,
        PhysicsSchedule,
        (
            call_team.in_set(Stage::ResetDiagnostics),
            (lifecycle::note_changed_colliders, crate::dynamics::drain::drain_lifecycle)
                .chain()
                .in_set(Stage::DrainLifecycle),
            crate::dynamics::drain::remove_lost_late.in_set(Stage::RemoveLost),
        ),
    );
    for (i, &(stage, name)) in Stage::ALL.iter().enumerate() {
        let end = (move |mut times: ResMut<StepTimes>| times.end(name)).after(stage);
        add_systems(
            app,
            PhysicsSchedule,
            match Stage::ALL.get(i + 1) {
                Some((next, _)) => end.before(*next),
                None => end.before(PhysicsStepSystems::Last),
            },
        );
    }
    #[cfg(feature = "validate")]
    crate::dynamics::validate::install(app);
}

/// Adds what all instances of a generic plugin share: with the first of them.
pub(crate) fn add_once<P: Plugin>(app: &mut App, shared: P) {
    if !app.is_plugin_added::<P>() {
        app.add_plugins(shared);
    }
}

/// The engine's own systems of a substep, in the public sets of [`SubstepSchedule`].
///
/// [`SubstepSchedule`]: crate::dynamics::solver::schedule::SubstepSchedule
pub(crate) mod substep {
    use super::{IntegrationSystems, SubstepSolverSystems};
    use crate::dynamics::solver::{SolverDiagnostics, schedule::SubstepSchedule, substeps::*};
    use bevy_app::App;
    use bevy_ecs::{intern::Interned, prelude::*, schedule::ScheduleLabel};

    /// Velocities and positions, in the schedule of the substeps or one that the app runs itself.
    pub(crate) fn add_integration(app: &mut App, schedule: Interned<dyn ScheduleLabel>) {
        app.init_resource::<OwnSubstepSystems>();
        if schedule == SubstepSchedule.intern() {
            let mut own = app.world_mut().resource_mut::<OwnSubstepSystems>();
            own.integrates = true;
            own.note(integrate_velocities);
            own.note(integrate_positions);
        }
        app.init_resource::<SolverDiagnostics>();
        super::add_systems(
            app,
            schedule,
            (
                integrate_velocities.in_set(IntegrationSystems::Velocity),
                integrate_positions.in_set(IntegrationSystems::Position),
            ),
        );
    }

    /// Contacts.
    pub(crate) fn add_contacts(app: &mut App) {
        app.init_resource::<OwnSubstepSystems>();
        let mut own = app.world_mut().resource_mut::<OwnSubstepSystems>();
        own.solves = true;
        own.note(warm_start);
        own.note(solve_contacts);
        own.note(relax_contacts);
        super::add_systems(
            app,
            SubstepSchedule,
            (
                warm_start.in_set(SubstepSolverSystems::WarmStart),
                solve_contacts.in_set(SubstepSolverSystems::SolveConstraints),
                relax_contacts.in_set(SubstepSolverSystems::Relax),
            ),
        );
    }
}

#[cfg(test)]
/// Has ambiguities with the engine's systems checked in spite of [`add_systems`].
#[derive(Resource)]
struct Strict;

#[cfg(all(test, feature = "default-collider"))]
mod tests {
    use super::*;
    use crate::{PhysicsPlugins, dynamics::solver::schedule::SubstepSchedule};
    use bevy_app::{TaskPoolPlugin, Update};

    /// Both schedules fail to build where an order is not determined.
    #[test]
    fn stages_determine_the_order_of_the_engines_systems() {
        let mut app = App::new();
        app.insert_resource(Strict).add_plugins((TaskPoolPlugin::default(), PhysicsPlugins::new(Update)));
        app.finish();
        let check = |app: &mut App, label: bevy_ecs::intern::Interned<dyn ScheduleLabel>| {
            app.world_mut().schedule_scope(label, |world, schedule| schedule.initialize(world).map(drop))
        };
        for label in [PhysicsSchedule.intern(), SubstepSchedule.intern()] {
            let built = check(&mut app, label);
            assert!(built.is_ok(), "{label:?}: {built:?}");
        }
    }
}
