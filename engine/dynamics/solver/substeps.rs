//! The solver's systems: rows, substeps, restitution, impulses.

use bevy_ecs::{prelude::*, schedule::ScheduleLabel};
use bevy_time::Time;
use kernel::solver::{RowInput, Softness, SubstepParams};

pub(crate) use super::step_solver::{OwnSubstepSystems, StepSolver};
use crate::{
    collision::narrow_phase::ContactResponse,
    dynamics::{
        joints::JointSolver,
        solver::{
            config::{ContactSoftnessCoefficients, LINEAR_SLOP, PhysicsLengthUnit, SolverConfig},
            diagnostics::SolverDiagnostics,
            schedule::{SubstepCount, SubstepSchedule, advance_substep, substep_delta},
            softness_parameters::SoftnessCoefficients,
            solver_body::lend::{lend_again, take_back},
            workers::{RowWidth, WorkerCount},
        },
        tables::{Bodies, Colliders, Contacts},
    },
    math::{Scalar, to_f32},
    schedule::{Physics, Substeps},
    threads::Threads,
};

/// Wakes the threads at the start of a step if the last step had much work, because waking takes longer than
/// most stages.
pub(crate) fn wake_workers(mut threads: ResMut<Threads>, contacts: Res<Contacts>, workers: Res<WorkerCount>) {
    threads.wake(contacts.table.active_len(), workers.0, || workers.resolve());
}

/// The friction centre fades out a separated point over this distance, times the length unit. A smaller value
/// makes friction jump when points open and close.
const FRICTION_FADE: f32 = (4.0 * LINEAR_SLOP) as f32;

/// Minimum approach speed of a blow, times the length unit. A smaller value strikes bodies that come to rest,
/// a larger value tilts bodies that fall flat from low heights.
const BLOW_SPEED: f32 = 0.5;

/// Light bodies that a heavy one presses into each other by more than this, times the length unit, get more
/// mass in the solver. A smaller value adds more mass, a larger value lets heavy bodies sink into light ones.
const MAX_SAG: f32 = LINEAR_SLOP as f32;

/// Full rolling resistance acts on round bodies that roll no faster than this, times the length unit, in m/s.
/// At twice this speed there is none. A smaller value keeps piles of balls and capsules awake, a larger value
/// slows down bodies that a game rolls on purpose.
const ROLL_SPEED: f32 = 0.2;

fn softness(c: SoftnessCoefficients) -> Softness {
    Softness {
        bias_rate: to_f32(c.bias),
        mass_scale: to_f32(c.mass_scale),
        impulse_scale: to_f32(c.impulse_scale),
    }
}

/// A setting of at least 0, clamped to a range that can be multiplied. A negative or NaN setting becomes the
/// default.
fn setting(value: Scalar, default: Scalar) -> f32 {
    to_f32(if value >= 0.0 { value.min(1.0e18) } else { default })
}

/// Computes the parameters that all rows share in this step.
pub(crate) fn prepare_params(
    mut solver: ResMut<StepSolver>,
    config: Option<Res<SolverConfig>>,
    soft: Option<Res<ContactSoftnessCoefficients>>,
    unit: Res<PhysicsLengthUnit>,
    (count, joints): (Res<SubstepCount>, Res<JointSolver>),
    time: Res<Time<Physics>>,
) {
    let config = config.map(|c| c.clone()).unwrap_or_default();
    let default = SolverConfig::default();
    let soft = soft.map(|s| *s).unwrap_or_default();
    let unit = unit.metres();
    let substeps = count.0.max(1);
    let dt = time.delta_secs();
    let h = dt / substeps as f32;
    solver.substeps = substeps;
    solver.params = SubstepParams {
        h,
        inv_h: if h > 0.0 { 1.0 / h } else { 0.0 },
        dt,
        soft: softness(soft.dynamic),
        stiff: softness(soft.non_dynamic),
        max_push_speed: setting(config.max_overlap_solve_speed, default.max_overlap_solve_speed) * unit,
        warm_start: setting(config.warm_start_coefficient, default.warm_start_coefficient).min(1.0),
        restitution_threshold: setting(config.restitution_threshold, default.restitution_threshold) * unit,
        blow_speed: BLOW_SPEED * unit,
        friction_fade: FRICTION_FADE * unit,
        max_sag: MAX_SAG * unit,
        roll_speed: ROLL_SPEED * unit,
        joints: (*joints).into(),
    };
}

/// Builds the rows of all joints and touching contacts.
#[expect(unsafe_code, reason = "the caller of `build_rows` answers for contacts and colours")]
pub(crate) fn prepare_rows(
    (bodies, colliders): (Res<Bodies>, Res<Colliders>),
    contacts: Res<Contacts>,
    (response, width): (Option<Res<ContactResponse>>, Res<RowWidth>),
    (mut solver, threads): (ResMut<StepSolver>, Res<Threads>),
    mut diagnostics: ResMut<SolverDiagnostics>,
) {
    let start = bevy_platform::time::Instant::now();
    let input = RowInput { contacts: &contacts.table, bodies: &bodies.table, colliders: &colliders.table };
    let StepSolver { kernel, params, .. } = &mut *solver;
    kernel.set_narrow(*width == RowWidth::Four);
    let others;
    let colors = if response.is_none_or(|r| r.0) {
        &contacts.colors
    } else {
        others = contacts.colors.without_contacts();
        &others
    };
    // SAFETY: the engine has one table of contacts, one graph and one table of bodies, which apps cannot
    // reach. It changes contacts, colours and the kinds of bodies only through `ContactManager`.
    // `without_contacts` leaves all other constraints unchanged.
    unsafe { kernel.build_rows(&input, colors, params, &threads.pool) };
    diagnostics.contact_constraint_count = kernel.manifold_count() as u32;
    diagnostics.prepare_constraints += start.elapsed();
}

/// Runs the substeps: in the kernel while the schedule contains only the engine's own systems, otherwise in
/// the schedule. The clock is already at the end of the first substep.
pub(crate) fn run_substeps(world: &mut World) {
    let own = world.resource::<OwnSubstepSystems>();
    let (integrates, solves) = (own.integrates, own.solves);
    let fused = world
        .get_resource::<Schedules>()
        .and_then(|schedules| schedules.get(SubstepSchedule))
        .is_none_or(|schedule| own.are_all_of(schedule));
    let substeps = world.resource::<StepSolver>().substeps;
    let delta = substep_delta(world.resource::<Time<Physics>>().delta(), SubstepCount(substeps));
    let next = |world: &mut World| advance_substep(&mut world.resource_mut::<Time<Substeps>>(), delta);
    if !fused {
        run_schedule(world, substeps, next);
        return take_back(world);
    }
    take_back(world);
    let start = bevy_platform::time::Instant::now();
    // A clone shares the threads.
    let pool = &world.resource::<Threads>().pool.clone();
    let mut solver = world.resource_mut::<StepSolver>();
    let StepSolver { kernel, params, .. } = &mut *solver;
    for _ in 0..substeps {
        match (integrates, solves) {
            (true, true) => kernel.substep(params, pool),
            (true, false) => {
                kernel.integrate_velocities(params, pool);
                kernel.integrate_positions(params, pool);
            }
            (false, true) => {
                kernel.warm_start(params, pool);
                kernel.solve(params, pool);
                kernel.relax(params, pool);
            }
            (false, false) => {}
        }
    }
    (1..substeps).for_each(|_| next(world));
    world.resource_mut::<SolverDiagnostics>().solve_constraints += start.elapsed();
    lend_again(world);
}

/// Runs the schedule for each substep. During the run, the generic clock is the substep clock.
fn run_schedule(world: &mut World, substeps: u32, mut next: impl FnMut(&mut World)) {
    let outer = *world.resource::<Time>();
    for substep in 0..substeps {
        if substep > 0 {
            next(world);
        }
        *world.resource_mut::<Time>() = world.resource::<Time<Substeps>>().as_generic();
        world.run_schedule(SubstepSchedule.intern());
    }
    *world.resource_mut::<Time>() = outer;
}

macro_rules! stage {
    ($(#[$doc:meta])* $system:ident => $stage:ident, $timer:ident) => {
        $(#[$doc])*
        pub(crate) fn $system(world: &mut World) {
            take_back(world);
            let start = bevy_platform::time::Instant::now();
            // A clone shares the threads.
            let pool = &world.resource::<Threads>().pool.clone();
            let mut solver = world.resource_mut::<StepSolver>();
            let StepSolver { kernel, params, .. } = &mut *solver;
            kernel.$stage(params, pool);
            world.resource_mut::<SolverDiagnostics>().$timer += start.elapsed();
            lend_again(world);
        }
    };
}

stage! {
    /// Integrates velocities by accelerations and damping.
    integrate_velocities => integrate_velocities, integrate_velocities
}
stage! {
    /// Applies the accumulated impulses.
    warm_start => warm_start, warm_start
}
stage! {
    /// Solves contacts with soft bias.
    solve_contacts => solve, solve_constraints
}
stage! {
    /// Integrates positions.
    integrate_positions => integrate_positions, integrate_positions
}
stage! {
    /// Solves contacts without bias, and applies friction.
    relax_contacts => relax, relax_velocities
}

/// Applies restitution.
pub(crate) fn apply_restitution(
    (mut solver, threads): (ResMut<StepSolver>, Res<Threads>),
    config: Res<SolverConfig>,
    mut diagnostics: ResMut<SolverDiagnostics>,
) {
    let start = bevy_platform::time::Instant::now();
    let StepSolver { kernel, params, .. } = &mut *solver;
    for _ in 0..config.restitution_iterations {
        kernel.restitute(params, &threads.pool);
    }
    diagnostics.apply_restitution += start.elapsed();
}

/// Stores the impulses for the warm start of the next step.
pub(crate) fn store_impulses(
    (mut solver, threads): (ResMut<StepSolver>, Res<Threads>),
    mut contacts: ResMut<Contacts>,
    mut diagnostics: ResMut<SolverDiagnostics>,
) {
    let start = bevy_platform::time::Instant::now();
    solver.kernel.store_impulses(&mut contacts.table, &threads.pool);
    diagnostics.store_impulses += start.elapsed();
}
