//! A line of dominoes, the first of which is already falling.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;

use crate::dim;
use crate::scene::{set_conditions, spawn_body, turned, yawed};

/// Width, height and depth of a domino in metres.
pub const SIZE: [f32; 3] = [0.15, 1.2, 0.6];

/// Distance between neighbours in metres, middle to middle.
pub const PITCH: f32 = 0.6;

/// `count` dominoes in a line (2D) or along a spiral (3D). The first leans far enough to fall onto the
/// second. Returns them in that order.
pub fn dominoes(world: &mut World, count: u32) -> Vec<Entity> {
    set_conditions(world);
    dim::spawn_domino_floor(world, count);
    let [width, height, depth] = SIZE;
    dim::domino_path(count)
        .into_iter()
        .enumerate()
        .map(|(i, (mut place, heading))| {
            let lean = if i == 0 { -0.25 } else { 0.0 };
            // A leaning box stands on its lower edge: its middle is (h cos + w |sin|) / 2 above that.
            let (sin, cos) = crate::sin_cos(lean);
            place.y += 0.5 * (height * cos + width * -sin);
            let rotation = yawed(heading) * turned(lean);
            let pose = Transform::from_translation(place).with_rotation(rotation);
            spawn_body(world, RigidBody::Dynamic, dim::block(width, height, depth), pose).id()
        })
        .collect()
}
