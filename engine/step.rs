//! The step: every system of the engine in [`PhysicsSchedule`], in the order in which it runs.
//!
//! One list names each stage, its public set, its systems, and the plugin that adds each system. It
//! determines both order and registration. A second list names the systems of a substep
//! ([`add_substep_systems_of`]). Disabling a plugin removes its systems.

use bevy_app::{App, Plugin};
use bevy_ecs::{intern::Interned, prelude::*, schedule::ScheduleLabel, system::ScheduleSystem};

use crate::{
    collider_tree::{ColliderTreeSystems, diagnostics::reset_trees},
    collision::{
        app_pairs::{apply_app_pairs, fill_graph},
        broad_phase::BroadPhaseSystems,
        collision_events::send_collision_events,
        collision_hits::{find_hits, note_approaches, send_hits},
        contact_types::{
            ContactGraph,
            views::{ContactViews, forget_views},
        },
        contacts::{link_contacts, note_touching, update_contacts},
        custom_contacts::CustomContacts,
        diagnostics::reset_collision,
        narrow_phase::{CollisionEventSystems, NarrowPhaseConfig, NarrowPhaseSystems},
        pairs::{FilterPairs, add_contacts, find_new_pairs, refit_awake, update_stale_boxes},
        removal,
    },
    dynamics::{
        ccd::{SweptCcdSystems, sweep::sweep_bodies},
        drain::{drain_lifecycle, remove_lost_late},
        integrator::IntegrationSystems,
        joints::{
            JointSolver,
            error::store_joint_errors,
            forces::{send_broken, store_joint_forces},
            lifecycle::note_changed_joints,
            settle::settle_joints,
            table::Joints,
        },
        lifecycle::{self, note_changed_colliders},
        materials::refresh_surfaces,
        rigid_body::{
            DefaultFriction, DefaultRestitution,
            forces::{
                ForceSystems,
                apply::{apply_forces, clear_forces, follow_forces},
                held::release_forces,
            },
            mass_properties::queue::{recompute, warn_of_missing_mass},
        },
        sleep::{follow_requests, mirror_sleeping, sleep_islands},
        solver::{
            config::update_contact_softness,
            diagnostics::{SolverDiagnostics, reset_solver},
            follow::follow_transforms,
            gather::{gather_bodies, read_awake, rest_kinematic, wake_changed, wake_kinematic_late},
            joint_graph::SyncEdges,
            scatter::{finish_bodies, keep_moved_within, note_moved_late, note_moved_within, scatter_bodies},
            schedule::{SolverSystems, SubstepSchedule, SubstepSolverSystems, start_substep_clock},
            solver_body::lend::{end_lending, lend_bodies, take_back},
            substeps::{
                OwnSubstepSystems, StepSolver, apply_restitution, integrate_positions, integrate_velocities,
                prepare_params, prepare_rows, relax_contacts, run_substeps, solve_contacts, store_impulses,
                wake_workers, warm_start,
            },
            workers::{RowWidth, WorkerCount},
        },
        tables::{Bodies, Colliders, Contacts},
    },
    physics_transform::position_to_transform,
    schedule::{PhysicsSchedule, PhysicsStepSystems, StepTimes},
    threads::Threads,
};

/// Defines the stages from the list below. An entry is `Name .place(set) => { Owner: systems, … }`: a stage,
/// its public set, and its systems by the plugin that adds them.
macro_rules! stages {
    ($(
        $(#[$doc:meta])*
        $stage:ident $(.$place:ident($set:expr))+ => { $($owner:ident: $systems:expr),* $(,)? }
    )+) => {
        /// The stages of a step, in order.
        #[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub(crate) enum Stage {
            $($(#[$doc])* $stage,)+
        }

        impl Stage {
            /// All stages, with their names.
            const ALL: &[(Self, &str)] = &[$((Self::$stage, stringify!($stage))),+];
        }

        /// Places a stage in its public set.
        fn place(app: &mut App, stage: Stage) {
            match stage {
                $(Stage::$stage => app.configure_sets(PhysicsSchedule, stage$(.$place($set))+),)+
            };
        }

        /// Adds the systems of an owner to [`PhysicsSchedule`] or a schedule that replaces it, each in its
        /// stage.
        pub(crate) fn add_systems_of(owner: Owner, app: &mut App, schedule: Interned<dyn ScheduleLabel>) {
            $($(
                if owner == Owner::$owner {
                    place(app, Stage::$stage);
                    add_systems(app, schedule, ($systems).in_set(Stage::$stage));
                }
            )*)+
        }
    };
}

/// The plugin that adds a system. Without this plugin the system does not run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Owner {
    /// Any plugin of the step.
    Step,
    /// `MassPropertyPlugin`.
    MassProperties,
    /// `ColliderTreePlugin`.
    Trees,
    /// `BvhBroadPhasePlugin`.
    BroadPhase,
    /// `NarrowPhasePlugin`.
    NarrowPhase,
    /// `SolverSchedulePlugin`.
    SolverSchedule,
    /// `ForcePlugin`.
    Forces,
    /// `SolverBodyPlugin`.
    SolverBodies,
    /// `IntegratorPlugin`.
    Integrator,
    /// `SolverPlugin`.
    Solver,
    /// `CcdPlugin`.
    Ccd,
    /// `JointPlugin`.
    Joints,
    /// `IslandSleepingPlugin`.
    Sleeping,
    /// `PhysicsTransformPlugin`.
    Transforms,
}

stages! {
    /// Resets the clock of the substeps.
    StartSubstepClock.before(PhysicsStepSystems::First) => { SolverSchedule: start_substep_clock }
    /// Recomputes masses of changed bodies, for steps taken by hand.
    UpdateMassProperties.before(PhysicsStepSystems::First) => {
        MassProperties: (recompute, warn_of_missing_mass).chain_ignore_deferred(),
    }
    /// Sets velocities of kinematic bodies that follow their transform.
    FollowTargets.before(PhysicsStepSystems::First) => { Transforms: follow_transforms }
    /// Moves characters. Systems: `CharacterControllerPlugin`.
    MoveCharacters.before(PhysicsStepSystems::First) => {}
    /// Resets counters and timers, and wakes the thread pool.
    ResetDiagnostics.in_set(PhysicsStepSystems::First) => {
        Step: wake_workers,
        Trees: reset_trees,
        NarrowPhase: reset_collision,
        Solver: reset_solver,
    }
    /// Adds, changes and removes bodies and colliders in the tables.
    DrainLifecycle.in_set(PhysicsStepSystems::First) => {
        Step: (note_changed_colliders, drain_lifecycle.pipe(forget_views)).chain(),
    }
    /// Adds, changes and removes joints in the tables.
    SettleJoints.in_set(PhysicsStepSystems::First) => {
        Joints: (note_changed_joints, settle_joints.pipe(forget_views)).chain().after(SyncEdges),
    }
    /// Adds and removes constraints of the app. Systems: `ConstraintPlugin`, `XpbdSolverPlugin`.
    SettleConstraints.in_set(PhysicsStepSystems::First) => {}
    /// Updates friction, restitution and margins from components.
    RefreshSurfaces.in_set(PhysicsStepSystems::First) => { NarrowPhase: refresh_surfaces }
    /// Puts islands to sleep and wakes them, as requested by the app.
    FollowSleep.in_set(PhysicsStepSystems::First) => { Sleeping: follow_requests }
    /// Wakes bodies with forces.
    FollowForces.in_set(PhysicsStepSystems::First) => { Forces: (release_forces, follow_forces).chain() }
    /// Wakes bodies that the app moved or pushed.
    FollowApp.in_set(PhysicsStepSystems::First) => { SolverBodies: (wake_changed, rest_kinematic).chain() }
    /// Reads poses and velocities of awake bodies.
    ReadAwake.in_set(PhysicsStepSystems::First) => { SolverBodies: read_awake }
    /// Updates boxes of colliders that were added, or moved by the app.
    UpdateBoxes.in_set(ColliderTreeSystems::UpdateAabbs) => { Trees: update_stale_boxes }
    /// Finds new pairs, and adds contacts for them.
    FindPairs.in_set(BroadPhaseSystems::CollectCollisions) => {
        BroadPhase: (find_new_pairs, add_contacts.pipe(forget_views).after(FilterPairs)).chain(),
    }
    /// Adds and removes pairs for the app.
    AppPairs
        .in_set(PhysicsStepSystems::BroadPhase)
        .after(BroadPhaseSystems::CollectCollisions)
        .before(BroadPhaseSystems::Last) => { Step: apply_app_pairs.pipe(forget_views) }
    /// Updates the manifolds of awake contacts.
    UpdateContacts.in_set(NarrowPhaseSystems::Update) => { NarrowPhase: update_contacts }
    /// Applies contacts that began or ended: colours, islands, waking.
    LinkContacts.in_set(NarrowPhaseSystems::Update) => {
        NarrowPhase: (link_contacts.pipe(forget_views), fill_graph, note_approaches).chain(),
    }
    /// Computes the softness of contacts from the length of the substeps.
    UpdateSoftness.after(PhysicsStepSystems::NarrowPhase).before(PhysicsStepSystems::Solver) => {
        Solver: update_contact_softness,
    }
    /// Fills the rows of awake bodies.
    Gather.in_set(SolverSystems::PrepareSolverBodies) => {
        SolverBodies: ((wake_kinematic_late, gather_bodies).chain(), lend_bodies).chain_ignore_deferred(),
    }
    /// Adds components for the displacements of bodies by constraints. Systems: `XpbdSolverPlugin`.
    PreparePositionSolve.in_set(SolverSystems::PrepareSolverBodies) => {}
    /// Adds forces to the rows of awake bodies.
    ApplyForces.in_set(ForceSystems::ApplyConstantForces) => { Forces: apply_forces }
    /// Computes the parameters of the substeps, even for bodies without contacts.
    PrepareParams.in_set(SolverSystems::PrepareJoints) => { SolverSchedule: prepare_params }
    /// Builds the rows of touching contacts.
    PrepareRows.in_set(SolverSystems::PrepareContactConstraints) => { Solver: prepare_rows }
    /// Runs the substeps.
    Substeps.in_set(SolverSystems::Substep) => { SolverSchedule: run_substeps }
    /// Ends the forces of this step.
    ClearForces.in_set(ForceSystems::Clear) => { Forces: clear_forces }
    /// Takes over the app's changes of bodies after the substeps.
    TakeBack.after(SolverSystems::PostSubstep).before(SweptCcdSystems) => { SolverBodies: take_back }
    /// Moves bodies that penetrated an obstacle back to the time of impact.
    Sweep.in_set(SweptCcdSystems) => { Ccd: sweep_bodies }
    /// Applies restitution.
    Restitution.in_set(SolverSystems::Restitution) => { Solver: apply_restitution }
    /// Adds the displacement in the substeps to the poses. One system, so no system of the app runs in
    /// between.
    FinishBodies.in_set(SolverSystems::Finalize) => { SolverBodies: note_moved_within.pipe(finish_bodies) }
    /// Writes poses and velocities to components. One system, so no system of the app runs in between.
    Scatter.in_set(SolverSystems::Finalize) => {
        SolverBodies: note_moved_late.pipe(scatter_bodies).pipe(keep_moved_within),
    }
    /// Writes poses to transforms. After this stage, a transform that the app sets is newer than the step.
    WriteTransforms.in_set(SolverSystems::Finalize) => { Transforms: position_to_transform }
    /// Stores impulses in the manifolds.
    StoreImpulses.in_set(SolverSystems::StoreContactImpulses) => {
        Solver: (store_impulses, find_hits).chain(),
    }
    /// Finds contacts that began to touch.
    NoteTouching.in_set(SolverSystems::StoreContactImpulses) => {
        NarrowPhase: (note_touching.pipe(forget_views), fill_graph).chain(),
    }
    /// Writes the forces and errors of joints.
    StoreJointForces.in_set(SolverSystems::StoreContactImpulses) => {
        Joints: (store_joint_forces, store_joint_errors).chain(),
    }
    /// Puts islands at rest to sleep.
    Sleep.in_set(PhysicsStepSystems::Sleeping) => { Sleeping: sleep_islands }
    /// Updates boxes of moved colliders, and the trees.
    Refit.in_set(PhysicsStepSystems::Finalize) => { Trees: refit_awake }
    /// Removes bodies and colliders that were despawned during the step.
    RemoveLost.in_set(PhysicsStepSystems::Finalize) => {
        Step: (remove_lost_late.pipe(forget_views), fill_graph).chain(),
    }
    /// Sends events of joints and collisions.
    SendEvents.in_set(CollisionEventSystems) => {
        NarrowPhase: (send_hits, send_collision_events).chain(),
        Joints: send_broken.before(send_hits),
    }
    /// Updates [`Sleeping`](crate::dynamics::rigid_body::sleeping::Sleeping) components.
    MirrorSleep.in_set(PhysicsStepSystems::Finalize) => { Sleeping: mirror_sleeping }
    /// Removes [`SolverBody`](crate::dynamics::solver::solver_body::SolverBody) from bodies that fell asleep
    /// or left.
    EndLending.in_set(PhysicsStepSystems::Finalize) => { SolverBodies: end_lending }
}

/// Adds systems of the engine to [`PhysicsSchedule`] or a schedule that replaces it.
///
/// Stages determine the order of the engine's systems, and systems of one stage are chained or share no data.
/// The order relative to the app's systems in the public sets is ambiguous without being an error: such a
/// system reads data from before or after a stage of its set, and its writes take effect where they are next
/// read.
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

/// Orders the stages and adds the tables. Every plugin that adds systems to the step calls it; only the first
/// call has an effect.
pub(crate) fn install(app: &mut App) {
    if app.world().contains_resource::<Bodies>() {
        return;
    }
    app.init_resource::<Bodies>()
        .init_resource::<Colliders>()
        .init_resource::<Contacts>()
        .init_resource::<ContactViews>()
        .init_resource::<ContactGraph>()
        .init_resource::<CustomContacts>()
        .init_resource::<StepSolver>()
        .init_resource::<Joints>()
        .init_resource::<JointSolver>()
        .init_resource::<WorkerCount>()
        .init_resource::<RowWidth>()
        .init_resource::<StepTimes>()
        .init_resource::<Threads>()
        // Colliders have a surface with or without the narrow phase.
        .init_resource::<DefaultFriction>()
        .init_resource::<DefaultRestitution>()
        .init_resource::<NarrowPhaseConfig>();
    lifecycle::watch(app);
    removal::watch(app);
    Stage::ALL.iter().for_each(|(stage, _)| place(app, *stage));
    add_systems_of(Owner::Step, app, PhysicsSchedule.intern());
    app.configure_sets(PhysicsSchedule, Timers.run_if(|times: Res<StepTimes>| times.are_read()));
    for (i, &(stage, name)) in Stage::ALL.iter().enumerate() {
        let end = (move |mut times: ResMut<StepTimes>| times.end(name)).in_set(Timers).after(stage);
        let end = match Stage::ALL.get(i + 1) {
            Some(&(next, _)) => {
                app.configure_sets(PhysicsSchedule, next.after(stage));
                end.before(next)
            }
            None => end.before(PhysicsStepSystems::Last),
        };
        add_systems(app, PhysicsSchedule, end);
    }
    #[cfg(feature = "validate")]
    crate::dynamics::validate::install(app);
}

/// The systems that record the time after each stage.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Timers;

/// Adds a plugin that all instances of a generic plugin share. Only the first instance adds it.
pub(crate) fn add_once<P: Plugin>(app: &mut App, shared: P) {
    if !app.is_plugin_added::<P>() {
        app.add_plugins(shared);
    }
}

/// Adds the substep systems of an owner to [`SubstepSchedule`] or a schedule that replaces it, each in its
/// public set.
///
/// [`SubstepSchedule`]: crate::dynamics::solver::schedule::SubstepSchedule
pub(crate) fn add_substep_systems_of(owner: Owner, app: &mut App, schedule: Interned<dyn ScheduleLabel>) {
    use IntegrationSystems::{Position, Velocity};
    use Owner::{Integrator, Solver};
    use SubstepSolverSystems::{Relax, SolveConstraints, WarmStart};
    app.init_resource::<OwnSubstepSystems>().init_resource::<SolverDiagnostics>();
    let mut substep = Substep { owner, app, schedule };
    substep.add(Integrator, Velocity, integrate_velocities);
    substep.add(Solver, WarmStart, warm_start);
    substep.add(Solver, SolveConstraints, solve_contacts);
    substep.add(Integrator, Position, integrate_positions);
    substep.add(Solver, Relax, relax_contacts);
}

/// The schedule that receives the substep systems of one owner.
struct Substep<'a> {
    owner: Owner,
    app: &'a mut App,
    schedule: Interned<dyn ScheduleLabel>,
}

impl Substep<'_> {
    /// Adds a system to a public set, if it belongs to the owner.
    fn add<M>(&mut self, owner: Owner, set: impl SystemSet, system: impl IntoSystem<(), (), M> + Copy) {
        if self.owner != owner {
            return;
        }
        if self.schedule == SubstepSchedule.intern() {
            let mut own = self.app.world_mut().resource_mut::<OwnSubstepSystems>();
            own.integrates |= owner == Owner::Integrator;
            own.solves |= owner == Owner::Solver;
            own.note(system);
        }
        add_systems(self.app, self.schedule, system.in_set(set));
    }
}

#[cfg(test)]
/// Enables checks for ambiguities with the engine's systems, which [`add_systems`] otherwise disables.
#[derive(Resource)]
struct Strict;

#[cfg(all(test, feature = "default-collider"))]
mod tests {
    use super::*;
    use crate::PhysicsPlugins;
    use bevy_app::{TaskPoolPlugin, Update};
    use bevy_ecs::schedule::{ApplyDeferred, InternedSystemSet};
    use core::any::TypeId;

    /// Every system of the step runs in a stage or after a stage, stages run in the order of the list, and no
    /// stage is empty.
    #[test]
    fn every_system_of_the_step_is_in_one_stage_and_stages_run_in_order() {
        let mut app = App::new();
        app.insert_resource(Strict).add_plugins((TaskPoolPlugin::default(), PhysicsPlugins::new(Update)));
        app.finish();
        app.world_mut().schedule_scope(PhysicsSchedule, |world, schedule| {
            schedule.initialize(world).expect("the order is determined");
            let members =
                |set: InternedSystemSet| schedule.graph().systems_in_set(set).expect("the set exists");
            let timers = members(Timers.intern());
            let last = members(PhysicsStepSystems::Last.intern());
            let (mut ran, mut others) = (Vec::new(), Vec::new());
            for (place, (key, system)) in schedule.systems().expect("the schedule is built").enumerate() {
                let stages = Stage::ALL.iter().filter(|(stage, _)| members(stage.intern()).contains(&key));
                let stages: Vec<_> = stages.map(|(stage, _)| *stage).collect();
                assert!(stages.len() <= 1, "{}: {stages:?}", system.name());
                let is_known = timers.contains(&key) || last.contains(&key);
                let is_bevys = system.system_type() == TypeId::of::<ApplyDeferred>();
                if stages.is_empty() && !is_known && !is_bevys {
                    others.push((place, system.name()));
                }
                ran.extend(stages);
            }
            // The system that records the length of the step is last.
            let count = schedule.systems_len();
            assert!(others.len() == 1 && others[0].0 == count - 1, "in no stage: {others:?} of {count}");
            ran.dedup();
            let is_of_xpbd =
                |stage: &Stage| matches!(stage, Stage::SettleConstraints | Stage::PreparePositionSolve);
            let wanted = Stage::ALL.iter().map(|(stage, _)| *stage);
            let has_xpbd = cfg!(feature = "xpbd_joints");
            assert_eq!(ran, wanted.filter(|stage| has_xpbd || !is_of_xpbd(stage)).collect::<Vec<_>>());
        });
    }

    /// Both schedules fail to build if any order is not determined.
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
