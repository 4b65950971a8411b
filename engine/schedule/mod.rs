//! Schedules of physics: [`PhysicsSchedule`] is one step, [`PhysicsSystems`] are its sets in the hosting
//! schedule, [`PhysicsStepSystems`] are the sets of a step, and the [clocks](Physics) define its length.

mod step_times;
mod time;

pub use step_times::StepTimes;
pub use time::*;

use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::{
    change_detection::Tick,
    intern::Interned,
    prelude::*,
    schedule::{LogLevel, ScheduleBuildSettings, ScheduleLabel, SingleThreadedExecutor},
    system::SystemChangeTick,
};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use bevy_time::Time;
use bevy_transform::TransformSystems;
use core::time::Duration;

use crate::threads::Threads;

/// Adds [`PhysicsSchedule`], the clocks, the system sets, and the system that takes one step per run of the
/// hosting schedule.
///
/// Without this plugin there are no clocks and no step is taken.
///
/// [`FixedPostUpdate`], the default, gets Bevy's single-threaded executor: a step is parallel inside its
/// systems, and moving systems between threads takes longer than a step of some hundred bodies. The app's
/// systems in [`FixedPostUpdate`] then also run one after the other. If that is too slow, set another
/// executor after the plugin is added. Other hosting schedules keep their executor.
pub struct PhysicsSchedulePlugin {
    schedule: Interned<dyn ScheduleLabel>,
}

impl PhysicsSchedulePlugin {
    /// Hosts physics in `schedule`; the default is [`FixedPostUpdate`].
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern() }
    }
}

impl Default for PhysicsSchedulePlugin {
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl Plugin for PhysicsSchedulePlugin {
    fn build(&self, app: &mut App) {
        // The generic clock belongs to the app. It is added here for apps without `TimePlugin`.
        app.init_resource::<Time>()
            .init_resource::<Time<Physics>>()
            .init_resource::<Time<Substeps>>()
            .init_resource::<LastPhysicsTick>()
            .init_resource::<SimulatedTime>()
            .init_resource::<StepTimes>()
            .init_resource::<Threads>();

        app.configure_sets(
            self.schedule,
            (
                PhysicsSystems::First,
                PhysicsSystems::Prepare,
                PhysicsSystems::StepSimulation,
                PhysicsSystems::Writeback,
                PhysicsSystems::Last,
            )
                .chain()
                .before(TransformSystems::Propagate),
        );
        app.add_systems(
            self.schedule,
            (
                (|mut times: ResMut<StepTimes>, _: OnThisThread| times.begin())
                    .after(PhysicsSystems::First)
                    .before(PhysicsSystems::Prepare),
                run_physics_schedule.in_set(PhysicsSystems::StepSimulation),
                end_writeback.after(PhysicsSystems::Writeback).before(PhysicsSystems::Last),
            ),
        );

        if self.schedule == FixedPostUpdate.intern() {
            app.edit_schedule(self.schedule, |schedule| {
                schedule.set_executor(SingleThreadedExecutor::new());
            });
        }
        app.edit_schedule(PhysicsSchedule, make_deterministic);
        app.configure_sets(
            PhysicsSchedule,
            (
                PhysicsStepSystems::First,
                PhysicsStepSystems::BroadPhase,
                PhysicsStepSystems::NarrowPhase,
                PhysicsStepSystems::Solver,
                PhysicsStepSystems::Sleeping,
                PhysicsStepSystems::Finalize,
                PhysicsStepSystems::Last,
            )
                .chain(),
        );
        app.add_systems(PhysicsSchedule, record_step.after(PhysicsStepSystems::Last).ambiguous_with_all());
    }
}

/// Ends the last part of a step, and parks the threads, because later systems may need the cores.
fn end_writeback(mut times: ResMut<StepTimes>, threads: Res<Threads>, _: OnThisThread) {
    times.end("Writeback");
    times.note_shared(&threads.pool);
    threads.pool.rest();
}

/// A parameter that keeps a system of a multi-threaded hosting schedule on the thread that runs the schedule.
/// Most of these systems do little work: handing them to another thread would take a hundred times as long.
pub(crate) use bevy_ecs::system::NonSendMarker as OnThisThread;

/// Makes a schedule run its systems one after the other, and makes an ambiguous order an error.
///
/// A step is parallel inside its systems. One task per system would cost more than it saves.
pub(crate) fn make_deterministic(schedule: &mut Schedule) {
    schedule.set_executor(SingleThreadedExecutor::new()).set_build_settings(ScheduleBuildSettings {
        ambiguity_detection: LogLevel::Error,
        ..ScheduleBuildSettings::default()
    });
}

/// One step of the simulation. Its sets are [`PhysicsStepSystems`].
///
/// Systems run one after the other, and an ambiguous order is an error: use `.before` or `.after` if two of
/// your systems share data. The order relative to the engine's own systems in the same set may be ambiguous:
/// shared data is then read either before or after them. [Run by hand](Physics#stepping-by-hand), a step is
/// as long as the delta of [`Time<Physics>`](Physics), independent of the generic [`Time`].
#[derive(Debug, Hash, PartialEq, Eq, Clone, ScheduleLabel)]
pub struct PhysicsSchedule;

/// Runs instead of [`PhysicsSchedule`] if the hosting schedule runs without taking a step: while physics is
/// paused, or at a relative speed of 0.
#[derive(Debug, Hash, PartialEq, Eq, Clone, ScheduleLabel)]
pub(crate) struct SkippedStep;

/// System sets of physics in the hosting schedule, in this order, before [`TransformSystems::Propagate`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PhysicsSystems {
    /// Before physics.
    First,
    /// Read changes of the app: transforms, hierarchies, colliders, mass properties.
    Prepare,
    /// Advance the clock and, unless it is paused, run [`PhysicsSchedule`].
    StepSimulation,
    /// Write results to other components: positions and rotations to transforms.
    Writeback,
    /// After physics.
    Last,
}

/// The former name of [`PhysicsSystems`].
#[deprecated(since = "0.4.0", note = "renamed to `PhysicsSystems`")]
pub type PhysicsSet = PhysicsSystems;

/// System sets of a step, in this order, in [`PhysicsSchedule`].
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_app::prelude::*;
/// # use bevy_ecs::prelude::*;
/// /// Wind, in every step before bodies are solved.
/// fn blow(mut bodies: Query<&mut LinearVelocity>) {
///     for mut velocity in &mut bodies {
///         velocity.0 += Vector::X * 0.1;
///     }
/// }
///
/// # let mut app = App::new();
/// app.add_systems(PhysicsSchedule, blow.in_set(PhysicsStepSystems::First));
/// ```
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PhysicsStepSystems {
    /// Before the step.
    First,
    /// Find pairs of colliders whose boxes overlap.
    BroadPhase,
    /// Compute the contacts of those pairs.
    NarrowPhase,
    /// Integrate velocities and positions, and solve contacts and joints, in substeps.
    Solver,
    /// Put islands at rest to sleep.
    Sleeping,
    /// Send collision events, and write diagnostics.
    Finalize,
    /// After the step.
    Last,
}

/// The former name of [`PhysicsStepSystems`].
#[deprecated(since = "0.4.0", note = "renamed to `PhysicsStepSystems`")]
pub type PhysicsStepSet = PhysicsStepSystems;

/// The change tick at the end of the last step.
///
/// Newer changes were made by the app, or by the write-back of that step, not by the step itself. A run of
/// the hosting schedule without a step does not change this tick: changes by the app while physics is paused
/// are new for the next step.
#[derive(Resource, Reflect, Default)]
#[reflect(Resource, Default)]
pub struct LastPhysicsTick(pub Tick);

/// Elapsed [`Time<Physics>`](Physics) at the end of the last step.
///
/// If the paused clock is ahead of it, the clock was advanced by hand and the corresponding step is still
/// due.
#[derive(Resource, Default)]
struct SimulatedTime(Duration);

fn record_step(
    mut last_tick: ResMut<LastPhysicsTick>,
    mut simulated: ResMut<SimulatedTime>,
    clock: Res<Time<Physics>>,
    tick: SystemChangeTick,
) {
    last_tick.0 = tick.this_run();
    simulated.0 = clock.elapsed();
}

/// Advances [`Time<Physics>`](Physics), and takes one step of that length unless the length is zero.
///
/// The first run is no exception: if the host's clock has not started, there is no time to simulate.
fn run_physics_schedule(world: &mut World) {
    let host_delta = world.resource::<Time>().delta();
    let simulated = world.resource::<SimulatedTime>().0;
    let mut clock = world.resource_mut::<Time<Physics>>();

    let paused = clock.is_paused();
    if !paused {
        let delta = scaled_delta(&clock, host_delta);
        clock.advance_by(delta);
    } else if clock.elapsed() <= simulated {
        clock.advance_by(Duration::ZERO);
    }
    if clock.delta().is_zero() {
        _ = world.try_run_schedule(SkippedStep);
        return;
    }

    let generic = clock.as_generic();
    world.resource_mut::<StepTimes>().end("Prepare");
    with_generic_time(world, generic, |world| world.run_schedule(PhysicsSchedule));

    let mut clock = world.resource_mut::<Time<Physics>>();
    if paused && clock.is_paused() {
        clock.advance_by(Duration::ZERO);
    }
}
