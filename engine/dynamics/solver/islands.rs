//! Islands: bodies that touch fall asleep and wake together.

pub use crate::dynamics::sleep::{SleepBody, WakeBody};

use bevy_app::{App, Plugin};
use bevy_ecs::schedule::ScheduleLabel;

use crate::{
    dynamics::{
        rigid_body::{
            RigidBody,
            sleeping::{SleepThreshold, SleepTimer, TimeToSleep},
        },
        sleep::watch_sleeping,
        tables::PhysicsIslands,
    },
    schedule::PhysicsSchedule,
    step::{self, Owner},
};

/// Groups awake bodies that touch into islands.
pub struct IslandPlugin;

impl Plugin for IslandPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<PhysicsIslands>();
    }
}

/// Puts islands at rest to sleep and wakes them. Needs [`IslandPlugin`].
pub struct IslandSleepingPlugin;

impl Plugin for IslandSleepingPlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        watch_sleeping(app);
        app.init_resource::<TimeToSleep>();
        // Registration fails only if the requirement exists already.
        let _ = app.try_register_required_components::<RigidBody, SleepThreshold>();
        let _ = app.try_register_required_components::<RigidBody, SleepTimer>();
        step::add_systems_of(Owner::Sleeping, app, PhysicsSchedule.intern());
    }
}
