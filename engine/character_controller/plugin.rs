//! [`CharacterControllerPlugin`]: characters in the step.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use super::{
    controller::{CharacterClimbed, CharacterController, CharacterHit, CharacterLanded, CharacterLeftGround},
    planning::CharacterPlan,
    system::{drive_characters, plan_characters},
};
use crate::{
    schedule::{PhysicsSchedule, PhysicsStepSystems},
    step::{self, Stage},
};

/// Moves characters with a [`CharacterController`], at the start of each step.
#[derive(Debug, Default)]
pub struct CharacterControllerPlugin;

/// The systems that move characters, in [`PhysicsSchedule`] before [`PhysicsStepSystems::First`]. What sets
/// [`CharacterInput`](super::controller::CharacterInput), or the velocity of a platform, runs before.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CharacterSystems;

impl Plugin for CharacterControllerPlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        app.register_required_components::<CharacterController, CharacterPlan>();
        app.add_message::<CharacterLanded>()
            .add_message::<CharacterLeftGround>()
            .add_message::<CharacterHit>()
            .add_message::<CharacterClimbed>();
        app.configure_sets(PhysicsSchedule, CharacterSystems.before(PhysicsStepSystems::First));
        let systems = (plan_characters, drive_characters)
            .chain()
            .in_set(CharacterSystems)
            .in_set(Stage::MoveCharacters);
        step::add_systems(app, PhysicsSchedule, systems);
    }
}
