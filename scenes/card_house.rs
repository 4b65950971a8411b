//! A house of cards, held only by friction and balance.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;

use crate::dim;
use crate::numbers::sin_cos;
use crate::scene::{Watched, at, set_conditions, spawn_block, spawn_body, turned};

/// Length of a leaning card in metres.
pub const LENGTH: f32 = 1.0;
/// Thickness of all cards in metres.
pub const THICKNESS: f32 = 0.04;
/// Depth of all cards in metres; 3D only.
pub const DEPTH: f32 = 0.7;
/// Angle of the leaning cards to the vertical, in radians.
pub const LEAN: f32 = 0.35;
/// Friction between cards.
pub const CARD_FRICTION: f32 = 0.8;
/// Space between neighbours in a row, in metres.
const GAP: f32 = 0.002;

/// A house of `storeys` storeys; the lowest has as many pairs of leaning cards. The uppermost
/// pair is watched.
///
/// With lean α, length L and thickness t, a leaning card is L cos α + t sin α high and L sin α + t cos α
/// wide. It touches its partner with its inner upper corner, t/2 cos α + L/2 sin α from its own middle. A
/// pair is p = 2 (L sin α + t cos α) wide; the flat cards, a little shorter than p, lie from tip to tip, so
/// that the feet of the pair above stand over the tips of the pairs below.
pub fn card_house(world: &mut World, storeys: u32) {
    set_conditions(world);
    world.insert_resource(DefaultFriction(Friction::new(CARD_FRICTION)));
    spawn_block(world, [40.0, 2.0, 40.0], at(0.0, -1.0, 0.0));
    let (sin, cos) = sin_cos(LEAN);
    let height = LENGTH * cos + THICKNESS * sin;
    let reach = 0.5 * (THICKNESS * cos + LENGTH * sin);
    let pitch = 2.0 * (LENGTH * sin + THICKNESS * cos) + GAP;
    let mut card = |length: f32, x: f32, y: f32, angle: f32, watched: bool| {
        let collider = dim::block(THICKNESS, length, DEPTH);
        let pose = Transform::from_xyz(x, y, 0.0).with_rotation(turned(angle));
        let mut body = spawn_body(world, RigidBody::Dynamic, collider, pose);
        if watched {
            body.insert(Watched(pose.translation));
        }
    };
    for storey in 0..storeys {
        let floor = storey as f32 * (height + THICKNESS);
        let pairs = storeys - storey;
        for i in 0..pairs {
            let tip = pitch * (i as f32 - 0.5 * (pairs - 1) as f32);
            let top = pairs == 1;
            card(LENGTH, tip - reach, floor + 0.5 * height, -LEAN, top);
            card(LENGTH, tip + reach, floor + 0.5 * height, LEAN, top);
            if i + 1 < pairs {
                let quarter = core::f32::consts::FRAC_PI_2;
                card(pitch - GAP, tip + 0.5 * pitch, floor + height + 0.5 * THICKNESS, quarter, false);
            }
        }
    }
}
