//! The plugin of XPBD constraints.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use super::{
    XpbdSolverSystems,
    links::{Links, note_links},
    project::{prepare_position_solve, project_velocities, record_pre_solve},
};
use crate::{
    dynamics::solver::{
        constraint::ties::{self, NoteTies},
        schedule::{SubstepSchedule, SubstepSolverSystems},
        step_solver::OwnSubstepSystems,
    },
    schedule::PhysicsSchedule,
    step::{self, Stage},
};

/// Enables XPBD constraints of the app; see the [module](super). Without these constraints it does nothing.
///
/// The engine's joints need neither this plugin nor XPBD.
pub struct XpbdSolverPlugin;

impl Plugin for XpbdSolverPlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        ties::install(app);
        app.init_resource::<Links>().init_resource::<OwnSubstepSystems>();
        app.configure_sets(
            SubstepSchedule,
            (
                XpbdSolverSystems::SolveConstraints,
                XpbdSolverSystems::SolveUserConstraints,
                XpbdSolverSystems::VelocityProjection,
            )
                .chain()
                .after(SubstepSolverSystems::Relax)
                .before(SubstepSolverSystems::Damping),
        );
        step::add_systems(app, PhysicsSchedule, note_links.in_set(NoteTies));
        step::add_systems(app, PhysicsSchedule, prepare_position_solve.in_set(Stage::PreparePositionSolve));

        let mut own = app.world_mut().resource_mut::<OwnSubstepSystems>();
        own.note(record_pre_solve);
        own.note(project_velocities);
        let record =
            record_pre_solve.after(SubstepSolverSystems::Relax).before(XpbdSolverSystems::SolveConstraints);
        step::add_systems(app, SubstepSchedule, record);
        let project = project_velocities.in_set(XpbdSolverSystems::VelocityProjection);
        step::add_systems(app, SubstepSchedule, project);
    }
}
