//! The plugin of continuous collision detection.

use bevy_app::{App, Plugin};
use bevy_ecs::{prelude::*, schedule::ScheduleLabel};

use super::SweptCcdSystems;
use crate::{
    dynamics::solver::{
        config::PhysicsLengthUnit, diagnostics::SolverDiagnostics, schedule::SolverSystems,
        substeps::OwnSubstepSystems,
    },
    schedule::{PhysicsSchedule, PhysicsStepSystems},
    step::{self, Owner},
};

/// Sweeps fast bodies against static geometry, and bodies with [`SweptCcd`](super::SweptCcd) against moving
/// bodies.
#[derive(Debug, Default)]
pub struct CcdPlugin;

impl Plugin for CcdPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<SolverDiagnostics>()
            .init_resource::<OwnSubstepSystems>()
            .init_resource::<PhysicsLengthUnit>();
        step::install(app);
        app.configure_sets(
            PhysicsSchedule,
            SweptCcdSystems
                .in_set(PhysicsStepSystems::Solver)
                .after(SolverSystems::PostSubstep)
                .before(SolverSystems::Restitution),
        );
        step::add_systems_of(Owner::Ccd, app, PhysicsSchedule.intern());
    }
}
