//! The headless Bevy app for both Avians, and for no physics: task pool, time, transforms.

use std::time::Instant;

use bench_core::{
    engine::{DT, Settings, Share, Stage},
    scene::Need,
};
use bevy::{
    app::{TaskPoolOptions, TaskPoolPlugin, TaskPoolThreadAssignmentPolicy},
    ecs::schedule::{Schedules, SingleThreadedExecutor},
    prelude::*,
    time::{TimePlugin, TimeUpdateStrategy},
};

/// Features that the Avian adapters do not support.
pub const LACKS: &[Need] = &[
    #[cfg(not(feature = "joints"))]
    Need::Joints,
    #[cfg(not(feature = "queries"))]
    Need::Queries,
    #[cfg(not(feature = "batches"))]
    Need::Batches,
    #[cfg(not(feature = "meshes"))]
    Need::Meshes,
    #[cfg(not(feature = "children"))]
    Need::Children,
];

/// The stages of an update in order, and their share. Clocks are between the public sets, added by
/// [`put_clocks`]; so a stage is all systems of its sets, and the stages add up to the whole update.
const STAGES: [(&str, Share); 14] = [
    ("before physics", Share::Bevy),
    ("transforms and masses in", Share::Ecs),
    ("life cycle, changes, reading", Share::Ecs),
    ("pairs", Share::Kernel),
    ("contacts", Share::Kernel),
    ("gather", Share::Ecs),
    ("rows", Share::Kernel),
    ("substeps", Share::Kernel),
    ("scatter", Share::Ecs),
    ("impulses", Share::Kernel),
    ("sleep", Share::Kernel),
    ("trees", Share::Kernel),
    ("write-back", Share::Ecs),
    ("after physics", Share::Bevy),
];

/// The end of the last stage, and the times of each of the last update, in milliseconds.
#[derive(Resource)]
pub struct StageClock {
    last: Instant,
    ms: [f64; STAGES.len()],
}

impl StageClock {
    fn end(&mut self, stage: usize) {
        let now = Instant::now();
        self.ms[stage] += (now - self.last).as_secs_f64() * 1e3;
        self.last = now;
    }
}

/// A system that ends a stage.
pub fn end<const STAGE: usize>(mut clock: ResMut<StageClock>) {
    clock.end(STAGE);
}

/// Adds a clock between the stages of the engine whose prelude is in scope.
macro_rules! put_clocks {
    ($app:expr) => {
        $app.add_systems(
            FixedPostUpdate,
            (
                app::end::<0>.after(PhysicsSystems::First).before(PhysicsSystems::Prepare),
                app::end::<1>.after(PhysicsSystems::Prepare).before(PhysicsSystems::StepSimulation),
                app::end::<12>.after(PhysicsSystems::Writeback).before(PhysicsSystems::Last),
            ),
        );
        $app.add_systems(
            PhysicsSchedule,
            (
                app::end::<2>.after(PhysicsStepSystems::First).before(PhysicsStepSystems::BroadPhase),
                app::end::<3>.after(PhysicsStepSystems::BroadPhase).before(PhysicsStepSystems::NarrowPhase),
                app::end::<4>.after(PhysicsStepSystems::NarrowPhase).before(PhysicsStepSystems::Solver),
                app::end::<5>.after(SolverSystems::PrepareSolverBodies).before(SolverSystems::PrepareJoints),
                app::end::<6>
                    .after(SolverSystems::PrepareContactConstraints)
                    .before(SolverSystems::PreSubstep),
                app::end::<7>.after(SolverSystems::Restitution).before(SolverSystems::Finalize),
                app::end::<8>.after(SolverSystems::Finalize).before(SolverSystems::StoreContactImpulses),
                app::end::<9>.after(PhysicsStepSystems::Solver).before(PhysicsStepSystems::Sleeping),
                app::end::<10>.after(PhysicsStepSystems::Sleeping).before(PhysicsStepSystems::Finalize),
                app::end::<11>.after(PhysicsStepSystems::Finalize).before(PhysicsStepSystems::Last),
            ),
        );
    };
}
pub(crate) use put_clocks;

/// The engine's own timers, from its diagnostics.
#[cfg(feature = "diagnostics")]
macro_rules! own_timers {
    ($avian:ident, $world:expr) => {{
        use $avian::{
            collider_tree::ColliderTreeDiagnostics, collision::CollisionDiagnostics,
            dynamics::solver::SolverDiagnostics,
        };
        let mut out = Vec::new();
        let mut add = |name: &str, time: std::time::Duration| {
            out.push(Stage::own(name, time.as_secs_f64() * 1e3));
        };
        if let Some(trees) = $world.get_resource::<ColliderTreeDiagnostics>() {
            add("tree update", trees.update);
            add("tree optimize", trees.optimize);
        }
        if let Some(collision) = $world.get_resource::<CollisionDiagnostics>() {
            add("broad phase", collision.broad_phase);
            add("narrow phase", collision.narrow_phase);
        }
        if let Some(solver) = $world.get_resource::<SolverDiagnostics>() {
            add("prepare", solver.prepare_constraints);
            add("integrate", solver.integrate_velocities + solver.integrate_positions);
            add("warm start", solver.warm_start);
            add("solve", solver.solve_constraints);
            add("relax", solver.relax_velocities);
            add("restitution", solver.apply_restitution);
            add("store", solver.store_impulses);
            add("sweeps", solver.swept_ccd);
            add("finalize", solver.finalize);
        }
        out
    }};
}
#[cfg(feature = "diagnostics")]
pub(crate) use own_timers;

/// The time in which several threads worked on the last step, by the engine.
#[cfg(feature = "sharing")]
macro_rules! shared {
    ($avian:ident, $world:expr) => {{
        let shared = $world.resource::<$avian::schedule::StepTimes>().shared();
        Stage::own(bench_core::engine::SHARED, shared.as_secs_f64() * 1e3)
    }};
}
#[cfg(feature = "sharing")]
pub(crate) use shared;

/// Makes an app in which one update runs exactly one fixed step.
///
/// There are as many compute threads as cores that the process is pinned to. Bevy's main thread also works
/// while it waits for them, on the same cores. `BENCH_BEVY_COMPUTE` overrides the number.
pub fn app(settings: &Settings) -> App {
    let compute = std::env::var("BENCH_BEVY_COMPUTE").ok().and_then(|v| v.parse().ok());
    let compute = compute.unwrap_or(settings.threads);
    let exactly = |n: usize| TaskPoolThreadAssignmentPolicy {
        min_threads: n,
        max_threads: n,
        percent: 1.0,
        on_thread_spawn: None,
        on_thread_destroy: None,
    };
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin {
            task_pool_options: TaskPoolOptions {
                min_total_threads: compute + 2,
                max_total_threads: compute + 2,
                io: exactly(1),
                async_compute: exactly(1),
                compute: exactly(compute),
            },
        },
        TimePlugin,
        TransformPlugin,
    ));
    app.insert_resource(Time::<Fixed>::from_hz((1.0 / DT as f64).round()));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app
}

/// Finishes the app. With one thread every schedule runs without the task pool.
pub fn finish(app: &mut App, settings: &Settings) {
    if settings.stages {
        app.insert_resource(StageClock { last: Instant::now(), ms: Default::default() });
    }
    app.finish();
    app.cleanup();
    if settings.threads == 1 {
        let mut schedules = app.world_mut().resource_mut::<Schedules>();
        for (_, schedule) in schedules.iter_mut() {
            schedule.set_executor(SingleThreadedExecutor::new());
        }
    }
    // Bevy's clock starts with an update without elapsed time, in which the engine adds the scene.
    app.update();
}

/// Updates the app once.
pub fn update(app: &mut App) {
    if let Some(mut clock) = app.world_mut().get_resource_mut::<StageClock>() {
        clock.ms = Default::default();
        clock.last = Instant::now();
    }
    app.update();
    if let Some(mut clock) = app.world_mut().get_resource_mut::<StageClock>() {
        clock.end(STAGES.len() - 1);
    }
}

/// The stages of the last update.
pub fn stages(world: &World) -> Vec<Stage> {
    let Some(clock) = world.get_resource::<StageClock>() else {
        return Vec::new();
    };
    let stages = STAGES.iter().zip(clock.ms);
    stages.map(|(&(name, share), ms)| Stage { name: name.to_owned(), share, ms }).collect()
}
