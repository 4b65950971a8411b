//! Timers and counters of the solver.

use crate::diagnostics::diagnostic_paths;
use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;

/// Timers and counters of the solver in the last step.
///
/// While [`SubstepSchedule`](super::schedule::SubstepSchedule) contains only the engine's own systems, all
/// substeps run as one call, and [`solve_constraints`](Self::solve_constraints) measures their time.
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct SolverDiagnostics {
    /// Gathering bodies and building constraint rows.
    pub prepare_constraints: Duration,
    /// Adding forces to the rows of bodies. [`integrate_velocities`](Self::integrate_velocities) includes
    /// gravity.
    pub update_velocity_increments: Duration,
    /// Integrating velocities.
    pub integrate_velocities: Duration,
    /// Applying the impulses of the last substep.
    pub warm_start: Duration,
    /// Solving contacts, or all substeps if they run as one call.
    pub solve_constraints: Duration,
    /// Integrating positions.
    pub integrate_positions: Duration,
    /// Relaxing velocities.
    pub relax_velocities: Duration,
    /// Applying restitution.
    pub apply_restitution: Duration,
    /// Finishing bodies and writing components.
    pub finalize: Duration,
    /// Storing impulses.
    pub store_impulses: Duration,
    /// Sweeping fast bodies, and bodies with [`SweptCcd`](crate::dynamics::ccd::SweptCcd).
    pub swept_ccd: Duration,
    /// Number of contact manifolds that were solved.
    pub contact_constraint_count: u32,
}

diagnostic_paths! {
    SolverDiagnostics {
        timer PREPARE_CONSTRAINTS: "avian/solver/prepare_constraints" = prepare_constraints,
        timer UPDATE_VELOCITY_INCREMENTS: "avian/solver/update_velocity_increments" = update_velocity_increments,
        timer INTEGRATE_VELOCITIES: "avian/solver/integrate_velocities" = integrate_velocities,
        timer WARM_START: "avian/solver/warm_start" = warm_start,
        timer SOLVE_CONSTRAINTS: "avian/solver/solve_constraints" = solve_constraints,
        timer INTEGRATE_POSITIONS: "avian/solver/integrate_positions" = integrate_positions,
        timer RELAX_VELOCITIES: "avian/solver/relax_velocities" = relax_velocities,
        timer APPLY_RESTITUTION: "avian/solver/apply_restitution" = apply_restitution,
        timer FINALIZE: "avian/solver/finalize" = finalize,
        timer STORE_IMPULSES: "avian/solver/store_impulses" = store_impulses,
        timer SWEPT_CCD: "avian/solver/swept_ccd" = swept_ccd,
        counter CONTACT_CONSTRAINT_COUNT: "avian/solver/contact_constraint_count" = contact_constraint_count,
    }
    reset reset_solver
}

pub(crate) fn reset_solver(mut diagnostics: ResMut<SolverDiagnostics>) {
    *diagnostics = SolverDiagnostics::default();
}
