//! The plugin that puts the solver's stages in order.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use super::{SolverSystems, SubstepCount, SubstepSchedule, SubstepSolverSystems, start_substep_clock};
use crate::{
    dynamics::{
        integrator::IntegrationSystems,
        solver::{
            config::PhysicsLengthUnit,
            diagnostics::SolverDiagnostics,
            substeps::{OwnSubstepSystems, prepare_params, run_substeps},
        },
    },
    schedule::{PhysicsSchedule, PhysicsStepSystems, make_deterministic},
    step::{self, Stage},
};

/// Adds [`SubstepSchedule`], [`SubstepCount`] and the order of [`SolverSystems`] and [`SubstepSolverSystems`].
#[derive(Debug, Default)]
pub struct SolverSchedulePlugin;

impl Plugin for SolverSchedulePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<SubstepCount>();

        app.configure_sets(
            PhysicsSchedule,
            (
                SolverSystems::PrepareSolverBodies,
                SolverSystems::PrepareJoints,
                SolverSystems::PrepareContactConstraints,
                SolverSystems::PreSubstep,
                SolverSystems::Substep,
                SolverSystems::PostSubstep,
                SolverSystems::Restitution,
                SolverSystems::Finalize,
                SolverSystems::StoreContactImpulses,
            )
                .chain()
                .in_set(PhysicsStepSystems::Solver),
        );
        app.init_resource::<SolverDiagnostics>()
            .init_resource::<OwnSubstepSystems>()
            .init_resource::<PhysicsLengthUnit>();
        step::install(app);
        step::add_systems(
            app,
            PhysicsSchedule,
            (
                start_substep_clock.before(PhysicsStepSystems::First),
                // Bodies move by these parameters also when no contacts are solved.
                prepare_params.in_set(SolverSystems::PrepareJoints),
                run_substeps.in_set(Stage::Substeps),
            ),
        );

        app.edit_schedule(SubstepSchedule, make_deterministic);
        app.configure_sets(
            SubstepSchedule,
            (
                IntegrationSystems::Velocity,
                SubstepSolverSystems::WarmStart,
                SubstepSolverSystems::SolveConstraints,
                IntegrationSystems::Position,
                SubstepSolverSystems::Relax,
                SubstepSolverSystems::Damping,
            )
                .chain(),
        );
    }
}
