//! The plugin that integrates bodies.

use bevy_app::{App, Plugin};
use bevy_ecs::{intern::Interned, prelude::*, schedule::ScheduleLabel};

use super::{Gravity, IntegrationSystems};
use crate::{
    dynamics::solver::schedule::{SolverSystems, SubstepSchedule},
    schedule::PhysicsSchedule,
    step::{self, Owner},
};

/// Integrates velocities and positions by semi-implicit Euler: velocities first, then positions with the new
/// velocities.
pub struct IntegratorPlugin {
    schedule: Interned<dyn ScheduleLabel>,
}

impl IntegratorPlugin {
    /// Integrates in `schedule`. The default is [`SubstepSchedule`]. An app with another schedule runs it
    /// once per substep: each run integrates over the length of one substep.
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern() }
    }
}

impl Default for IntegratorPlugin {
    fn default() -> Self {
        Self::new(SubstepSchedule)
    }
}

impl Plugin for IntegratorPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Gravity>();
        step::install(app);
        step::add_substep_systems_of(Owner::Integrator, app, self.schedule);

        app.configure_sets(
            self.schedule,
            (IntegrationSystems::Velocity, IntegrationSystems::Position).chain(),
        );
        app.configure_sets(
            PhysicsSchedule,
            (
                IntegrationSystems::UpdateVelocityIncrements.in_set(SolverSystems::PreSubstep),
                IntegrationSystems::ClearVelocityIncrements.in_set(SolverSystems::PostSubstep),
            ),
        );
    }
}
