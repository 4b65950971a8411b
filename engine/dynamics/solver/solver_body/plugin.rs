//! The plugin of the solver's body rows.

use bevy_app::{App, Plugin};
use bevy_ecs::schedule::ScheduleLabel;

use super::super::config::PhysicsLengthUnit;
use crate::{
    dynamics::integrator::Gravity,
    schedule::PhysicsSchedule,
    step::{self, Owner},
};

/// Fills the solver's rows from awake bodies before a solve, and writes the results to components.
pub struct SolverBodyPlugin;

impl Plugin for SolverBodyPlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        app.init_resource::<Gravity>().init_resource::<PhysicsLengthUnit>();
        step::add_systems_of(Owner::SolverBodies, app, PhysicsSchedule.intern());
    }
}
