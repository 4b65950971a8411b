//! The rows of bodies that the solver works on.

use bevy_app::{App, Plugin};
use bevy_ecs::schedule::ScheduleLabel;

use super::config::PhysicsLengthUnit;
use crate::{
    dynamics::integrator::Gravity,
    schedule::PhysicsSchedule,
    step::{self, Owner},
};

/// Gathers awake bodies into the solver's rows before a solve and writes them back after it.
pub struct SolverBodyPlugin;

impl Plugin for SolverBodyPlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        app.init_resource::<Gravity>().init_resource::<PhysicsLengthUnit>();
        step::add_systems_of(Owner::SolverBodies, app, PhysicsSchedule.intern());
    }
}
