//! The plugin of joints.

use bevy_app::{App, Plugin};
use bevy_ecs::{prelude::*, schedule::ScheduleLabel};

use super::{JointBroken, JointSystems, lifecycle};
use crate::{
    dynamics::solver::schedule::SolverSystems,
    schedule::PhysicsSchedule,
    step::{self, Owner},
};

/// Simulates joints. Without this plugin joints have no effect.
pub struct JointPlugin;

impl Plugin for JointPlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        lifecycle::watch(app);
        app.add_message::<JointBroken>();
        app.configure_sets(
            PhysicsSchedule,
            JointSystems::PrepareLocalFrames
                .after(SolverSystems::PrepareSolverBodies)
                .before(SolverSystems::PrepareJoints),
        );
        step::add_systems_of(Owner::Joints, app, PhysicsSchedule.intern());
    }
}
