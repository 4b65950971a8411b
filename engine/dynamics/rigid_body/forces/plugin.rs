//! The plugin of forces.

use bevy_app::{App, Plugin};
use bevy_ecs::{prelude::*, schedule::ScheduleLabel};

use super::{
    ForceSystems, apply,
    held::{HeldForces, hold_forces},
};
use crate::{
    dynamics::{
        integrator::IntegrationSystems,
        solver::schedule::{SolverSystems, SubstepSchedule},
    },
    schedule::{PhysicsSchedule, SkippedStep},
    step::{self, Owner},
};

/// Accelerates bodies by [`Forces`](super::Forces) and constant forces. Part of
/// [`PhysicsPlugins`](crate::PhysicsPlugins). Without this plugin forces have no effect, but impulses do.
pub struct ForcePlugin;

impl Plugin for ForcePlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        apply::watch(app);
        app.init_resource::<HeldForces>().add_systems(SkippedStep, hold_forces);
        step::add_systems_of(Owner::Forces, app, PhysicsSchedule.intern());
        app.configure_sets(
            PhysicsSchedule,
            (
                ForceSystems::ApplyConstantForces.in_set(SolverSystems::PrepareSolverBodies),
                ForceSystems::Clear.in_set(IntegrationSystems::ClearVelocityIncrements),
            ),
        );
        app.configure_sets(
            SubstepSchedule,
            ForceSystems::ApplyLocalAcceleration.in_set(IntegrationSystems::Velocity),
        );
    }
}
