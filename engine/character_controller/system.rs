//! The systems that move characters: each character plans its motion through the coming step, then its body
//! gets the velocity for this motion.
//!
//! All characters plan from the same state of the world, so that neither their order nor the number of
//! threads matters.

use bevy_ecs::{prelude::*, query::QueryData};
use bevy_time::Time;

use super::{
    bodies::BodiesAround,
    controller::{
        CharacterClimbed, CharacterController, CharacterHit, CharacterInput, CharacterLanded,
        CharacterLeftGround, CharacterState,
    },
    move_and_slide::{MoveAndSlide, MoveAndSlideConfig},
    mover::Mover,
    planning::{CharacterPlan, Planning, Push, Surroundings, is_friend},
    velocity_project::vector,
    walker::Walker,
};
use crate::{
    collision::collider::{Collider, CollisionLayers, LayerMask, SimpleCollider},
    dynamics::{
        ids::BodyId,
        integrator::Gravity,
        rigid_body::{
            GravityScale, LinearVelocity, RigidBodyDisabled,
            forces::{Forces, WriteRigidBodyForces},
        },
        solver::workers::WorkerCount,
    },
    math::{AdjustPrecision, Scalar, Vector, vector_from_kernel, vector_to_kernel},
    physics_transform::{Position, Rotation, world_pose},
    schedule::Physics,
    threads::Threads,
};

/// A character and its components.
#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct Character {
    entity: Entity,
    controller: &'static CharacterController,
    input: &'static CharacterInput,
    state: &'static mut CharacterState,
    plan: &'static mut CharacterPlan,
    shape: &'static Collider,
    position: &'static Position,
    rotation: &'static Rotation,
    layers: Option<&'static CollisionLayers>,
    gravity_scale: Option<&'static GravityScale>,
}

/// Plans the step of each character.
pub(super) fn plan_characters(
    mut characters: Query<Character, Without<RigidBodyDisabled>>,
    moves: MoveAndSlide,
    bodies: BodiesAround,
    gravity: Res<Gravity>,
    clock: Res<Time<Physics>>,
    (mut threads, workers): (ResMut<Threads>, Res<WorkerCount>),
) {
    let time = clock.delta_secs_f64().adjust_precision();
    if characters.is_empty() || !(time > 0.0) {
        return;
    }
    threads.wake_for_characters(characters.iter().len(), workers.0, || workers.resolve());
    let pushers = bodies.pushers(time);
    let gravity = gravity.0.length();
    let around = Surroundings { moves: &moves, bodies: &bodies, pushers: &pushers, gravity, time };
    let mut all: Vec<_> = characters.iter_mut().collect();
    threads.pool.each(all.iter_mut(), |character| plan(character, &around));
}

fn plan(character: &mut CharacterItem, around: &Surroundings) {
    *character.plan = CharacterPlan::default();
    let from = character.position.0;
    if *character.position == Position::PLACEHOLDER
        || !from.is_finite()
        || !character.input.velocity.is_finite()
    {
        return;
    }
    let controller = character.controller;
    let is_solid = solidity(around.moves, around.bodies, controller.friends, character.layers);
    let unit = around.moves.length_unit.0;
    let config = MoveAndSlideConfig::default();
    let up = vector(controller.up);
    let mover = Mover {
        queries: &around.moves.spatial_query,
        is_solid: &is_solid,
        ignored: around.bodies.colliders_of(character.entity).collect(),
        shape: character.shape,
        rotation: (*character.rotation).into(),
        filter: &controller.filter,
        skin: (controller.skin_width * unit).max(0.0),
        unit,
    };
    let feet = feet_of(character.shape, character.rotation, up);
    let walker = Walker {
        step_height: controller.step_height * unit,
        step_depth: controller.step_depth * unit,
        ..Walker::new(mover, from, (up, feet), controller.max_slope, &config)
    };
    let gravity = around.gravity * character.gravity_scale.map_or(1.0, |scale| scale.0);
    let mut planning = Planning {
        around,
        walker,
        state: *character.state,
        plan: CharacterPlan::default(),
        entity: character.entity,
        controller,
        input: *character.input,
        gravity: -up * gravity,
        unit,
        ridden_to: from,
        carried: character.state.carried(),
    };
    planning.run(from);
    *character.state = planning.state;
    *character.plan = planning.plan;
}

/// Whether a collider stops a character: if the layers of the character interact with it, and it is no
/// friend.
pub(super) fn solidity<'a>(
    moves: &'a MoveAndSlide<'a, 'a>,
    bodies: &'a BodiesAround<'a, 'a>,
    friends: LayerMask,
    layers: Option<&CollisionLayers>,
) -> impl Fn(Entity) -> bool + use<'a> {
    let own = layers.copied().unwrap_or_default();
    move |entity| {
        let is_met = |(.., other): (_, _, _, Option<&CollisionLayers>)| {
            own.interacts_with(other.copied().unwrap_or_default())
        };
        moves.colliders.get(entity).is_ok_and(is_met)
            && !(friends != LayerMask::NONE && is_friend(moves, bodies, friends, entity))
    }
}

/// The height of the lowest point of a shape relative to its position: negative below it.
pub(super) fn feet_of(shape: &Collider, rotation: &Rotation, up: Vector) -> Scalar {
    let pose = world_pose(&Position(Vector::ZERO), rotation);
    let down = pose.rotation.inverse_rotate(vector_to_kernel(-up));
    match shape.native().support(down) {
        Some(point) => vector_from_kernel(pose.rotation.rotate(point)).dot(up),
        // A shape without support points uses its box.
        None => {
            let aabb = shape.aabb(Vector::ZERO, *rotation);
            (aabb.center() - aabb.size() * 0.5 * up.abs()).dot(up)
        }
    }
}

/// The components with which a character is driven.
type Driven =
    (&'static BodyId, &'static mut CharacterPlan, &'static mut CharacterInput, &'static mut LinearVelocity);

/// Gives the bodies of characters their velocities, applies their pushes, and sends their events in order of
/// ids.
pub(super) fn drive_characters(
    mut characters: Query<Driven, Without<RigidBodyDisabled>>,
    mut others: Query<Forces, Without<CharacterPlan>>,
    mut messages: ParamSet<(
        MessageWriter<CharacterLanded>,
        MessageWriter<CharacterLeftGround>,
        MessageWriter<CharacterHit>,
        MessageWriter<CharacterClimbed>,
    )>,
    mut commands: Commands,
) {
    let mut plans = Vec::new();
    for (id, mut plan, mut input, mut velocity) in &mut characters {
        // The plan is taken, so that a character without a new plan stops.
        let plan = core::mem::take(&mut *plan);
        velocity.set_if_neq(LinearVelocity(plan.velocity));
        if input.jump != 0.0 {
            input.jump = 0.0;
        }
        plans.push((id.0, plan));
    }
    plans.sort_by_key(|(id, _)| *id);
    for (_, plan) in plans {
        for Push { body, point, force } in plan.pushes {
            if let Ok(mut forces) = others.get_mut(body) {
                forces.apply_force_at_point(force, point);
            }
        }
        if let Some(event) = plan.left {
            messages.p1().write(event);
            commands.trigger(event);
        }
        if let Some(event) = plan.landed {
            messages.p0().write(event);
            commands.trigger(event);
        }
        if let Some(event) = plan.climbed {
            messages.p3().write(event);
            commands.trigger(event);
        }
        for hit in plan.hits {
            messages.p2().write(hit);
            commands.trigger(hit);
        }
    }
}
