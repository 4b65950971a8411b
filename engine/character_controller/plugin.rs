//! [`CharacterControllerPlugin`]: characters in the step.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

use super::{
    controller::{CharacterClimbed, CharacterController, CharacterHit, CharacterLanded, CharacterLeftGround},
    crouch::{CharacterCrouch, change_stances},
    dynamic_mover::DynamicMover,
    hovering::{MoverPlan, drive_movers, plan_movers},
    planning::CharacterPlan,
    system::{drive_characters, plan_characters},
};
use crate::{
    dynamics::rigid_body::LinearVelocity,
    schedule::{PhysicsSchedule, PhysicsStepSystems},
    step::{self, Stage},
};

/// Moves characters with a [`CharacterController`], at the start of each step.
#[derive(Debug, Default)]
pub struct CharacterControllerPlugin;

/// The systems that move characters, in [`PhysicsSchedule`] before [`PhysicsStepSystems::First`]. Systems
/// that set [`CharacterInput`](super::controller::CharacterInput), or the velocity of a platform, run before.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CharacterSystems;

impl Plugin for CharacterControllerPlugin {
    fn build(&self, app: &mut App) {
        step::install(app);
        app.register_required_components::<CharacterController, CharacterPlan>();
        app.register_required_components::<DynamicMover, MoverPlan>();
        app.add_message::<CharacterLanded>()
            .add_message::<CharacterLeftGround>()
            .add_message::<CharacterHit>()
            .add_message::<CharacterClimbed>();
        app.configure_sets(PhysicsSchedule, CharacterSystems.before(PhysicsStepSystems::First));
        let systems = (
            change_stances.run_if(any_with_component::<CharacterCrouch>),
            plan_characters,
            drive_characters,
            (plan_movers, drive_movers).chain().run_if(any_with_component::<DynamicMover>),
        )
            .chain()
            .in_set(CharacterSystems)
            .in_set(Stage::MoveCharacters);
        step::add_systems(app, PhysicsSchedule, systems);
        app.add_observer(stop_characters).add_observer(stop_movers);
    }
}

/// Stops the body of a former character, and leaves it to the app.
fn stop_characters(
    removed: On<Remove, CharacterController>,
    mut velocities: Query<&mut LinearVelocity>,
    mut commands: Commands,
) {
    if let Ok(mut velocity) = velocities.get_mut(removed.entity) {
        *velocity = LinearVelocity::ZERO;
    }
    commands.entity(removed.entity).try_remove::<CharacterPlan>();
}

/// Leaves the body of a former mover to the app.
fn stop_movers(removed: On<Remove, DynamicMover>, mut commands: Commands) {
    commands.entity(removed.entity).try_remove::<MoverPlan>();
}
