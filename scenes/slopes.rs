//! Ramps of 20 degrees, one per body: rolling, sliding and sticking, by friction.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::Transform;

use crate::dim;
use crate::numbers::sin_cos;
use crate::scene::{FRICTION, Watched, set_conditions, spawn_block, spawn_body, turned};

/// Slope of the ramps in radians: 20 degrees. A box with friction above tan 20° = 0.364 sticks.
pub const ANGLE: f32 = 0.349_065_85;
/// Length of a ramp in metres.
pub const LENGTH: f32 = 24.0;
/// How far above the middle of its ramp a body starts, in metres along the slope.
const START: f32 = 10.0;

/// The body on a ramp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rider {
    /// A ball of radius 0.5.
    Ball,
    /// A cylinder of radius 0.5, lying across the slope; a circle in 2D.
    Roller,
    /// A unit box.
    Box,
}

/// Shape and friction of the body on each ramp.
pub const RIDERS: [(Rider, f32); 8] = [
    (Rider::Ball, 0.8),
    (Rider::Ball, 0.05),
    (Rider::Roller, 0.8),
    (Rider::Roller, 0.05),
    (Rider::Box, 0.0),
    (Rider::Box, 0.2),
    (Rider::Box, 0.4),
    (Rider::Box, 0.8),
];

/// One ramp for each of [`RIDERS`], going down to the left. The boxes that should stick are watched. Returns
/// the riders in that order.
pub fn slopes(world: &mut World) -> Vec<Entity> {
    set_conditions(world);
    RIDERS
        .iter()
        .enumerate()
        .map(|(lane, &(rider, friction))| spawn_lane(world, rider, friction, ANGLE, dim::lane(lane)))
        .collect()
}

/// One ramp with its middle at `middle`, rising to the right by `angle`, and one body near its upper end with
/// a friction. Returns the body.
pub fn spawn_lane(world: &mut World, rider: Rider, friction: f32, angle: f32, middle: Vec3) -> Entity {
    let (sin, cos) = sin_cos(angle);
    let rotation = turned(angle);
    let (along, normal) = (Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0));
    let pose = |offset: Vec3| Transform::from_translation(middle + offset).with_rotation(rotation);

    spawn_block(world, [LENGTH, 1.0, 2.0], pose(-0.5 * normal));
    spawn_block(world, [0.5, 1.0, 2.0], pose(-0.5 * LENGTH * along + 0.5 * normal));
    let collider = match rider {
        Rider::Ball => dim::ball(0.5),
        Rider::Roller => dim::roller(0.5, 1.0),
        Rider::Box => dim::block(1.0, 1.0, 1.0),
    };
    let start = pose(START * along + 0.5 * normal);
    // `Min` has priority over the ramp's `Average`, so the pair has the body's friction.
    let own = Friction::new(friction).with_combine_rule(CoefficientCombine::Min);
    let turn = if rider == Rider::Roller { dim::roller_turn() } else { bevy_math::Quat::IDENTITY };
    let start = start.with_rotation(start.rotation * turn);
    let mut body = spawn_body(world, RigidBody::Dynamic, collider, start);
    body.insert(own);
    let sticks = rider == Rider::Box && friction.min(FRICTION) * cos > sin;
    if sticks {
        body.insert(Watched(start.translation));
    }
    body.id()
}
