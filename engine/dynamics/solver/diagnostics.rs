//! Timers and counters of the solver.

use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;

/// Timers and counters of the solver in the last step.
///
/// While [`SubstepSchedule`](super::schedule::SubstepSchedule) holds only the engine's own systems, all substeps run as
/// one call, and their time is in [`solve_constraints`](Self::solve_constraints).
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct SolverDiagnostics {
    /// Gathering bodies and building constraint rows.
    pub prepare_constraints: Duration,
    /// Summing accelerations. Zero until there are forces: gravity is part of
    /// [`integrate_velocities`](Self::integrate_velocities).
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

pub(crate) fn reset_solver(mut diagnostics: ResMut<SolverDiagnostics>) {
    *diagnostics = SolverDiagnostics::default();
}
