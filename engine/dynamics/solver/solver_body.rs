//! The rows of bodies that the solver works on.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use super::{
    config::PhysicsLengthUnit,
    gather::{gather_bodies, read_awake, rest_kinematic, wake_changed},
    scatter::{finish_bodies, keep_moved_within, note_moved_late, note_moved_within, scatter_bodies},
};
use crate::{
    dynamics::integrator::Gravity,
    schedule::PhysicsSchedule,
    step::{self, Stage},
};

/// Gathers awake bodies into the solver's rows before a solve and writes them back after it.
pub struct SolverBodyPlugin;

impl Plugin for SolverBodyPlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        app.init_resource::<Gravity>().init_resource::<PhysicsLengthUnit>();
        step::add_systems(
            app,
            PhysicsSchedule,
            (
                (wake_changed, rest_kinematic).chain().in_set(Stage::FollowApp),
                read_awake.in_set(Stage::ReadAwake),
                gather_bodies.in_set(Stage::Gather),
                // Each is one system: none of the app's comes in between.
                note_moved_within.pipe(finish_bodies).in_set(Stage::FinishBodies),
                note_moved_late.pipe(scatter_bodies).pipe(keep_moved_within).in_set(Stage::Scatter),
            ),
        );
    }
}
