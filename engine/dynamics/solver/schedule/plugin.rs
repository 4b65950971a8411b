//! The plugin that orders the solver's system sets.

use bevy_app::{App, Plugin};
use bevy_ecs::{prelude::*, schedule::ScheduleLabel};

use super::{SolverSystems, SubstepCount, SubstepSchedule, SubstepSolverSystems};
use crate::{
    dynamics::{
        integrator::IntegrationSystems,
        solver::{config::PhysicsLengthUnit, diagnostics::SolverDiagnostics, substeps::OwnSubstepSystems},
    },
    schedule::{PhysicsSchedule, PhysicsStepSystems, make_deterministic},
    step::{self, Owner},
};

/// Adds [`SubstepSchedule`], [`SubstepCount`] and the order of [`SolverSystems`] and
/// [`SubstepSolverSystems`].
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
        step::add_systems_of(Owner::SolverSchedule, app, PhysicsSchedule.intern());

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
