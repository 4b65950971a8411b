//! Straight stacks of boxes, side by side. With too few iterations of the solver they sway and fall.

use avian::prelude::*;
use bevy_ecs::prelude::*;

use crate::dim;
use crate::scene::{Watched, at, set_conditions, spawn_block, spawn_body};

/// One tower of unit boxes for each given height, four metres apart; each top box is watched.
pub fn towers(world: &mut World, heights: &[u32]) {
    set_conditions(world);
    let pitch = 4.0;
    let width = pitch * (heights.len() as f32 + 4.0);
    spawn_block(world, [width, 2.0, width], at(0.0, -1.0, 0.0));
    for (i, &height) in heights.iter().enumerate() {
        let x = pitch * (i as f32 - 0.5 * (heights.len() as f32 - 1.0));
        for level in 0..height {
            let pose = at(x, level as f32 + 0.5, 0.0);
            let mut body = spawn_body(world, RigidBody::Dynamic, dim::block(1.0, 1.0, 1.0), pose);
            if level + 1 == height {
                body.insert(Watched(pose.translation));
            }
        }
    }
}
