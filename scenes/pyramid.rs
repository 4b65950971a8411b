//! Flat pyramids of unit boxes: the test of stacking, and of the solver's speed on many contacts.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::dim;
use crate::scene::{Watched, at, set_conditions, spawn_block, spawn_body};

/// Stacks one pyramid of touching unit boxes, `base` boxes wide at the bottom, its middle on `foot`. Its
/// bodies do not sleep; the topmost one is watched. Returns the boxes, bottom row first.
pub fn stack(world: &mut World, base: u32, foot: Vec3) -> Vec<Entity> {
    let mut boxes = Vec::new();
    for row in 0..base {
        let count = base - row;
        for i in 0..count {
            let x = i as f32 - 0.5 * (count - 1) as f32;
            let place = foot + Vec3::new(x, row as f32 + 0.5, 0.0);
            let pose = at(place.x, place.y, place.z);
            let mut body = spawn_body(world, RigidBody::Dynamic, dim::block(1.0, 1.0, 1.0), pose);
            body.insert(SleepingDisabled);
            if count == 1 {
                body.insert(Watched(place));
            }
            boxes.push(body.id());
        }
    }
    boxes
}

/// One pyramid on a wide floor, as Box2D's and Box3D's benchmark `large_pyramid` with `base` = 100.
pub fn large(world: &mut World, base: u32) -> Vec<Entity> {
    set_conditions(world);
    let width = dim::FLOOR_WIDTH.max(2.0 * base as f32);
    spawn_block(world, [width, 2.0, width], at(0.0, -1.0, 0.0));
    stack(world, base, Vec3::ZERO)
}

/// `rows` × `columns` pyramids of base `base`: on floors above each other in 2D, behind each other on one
/// floor in 3D; as Box2D's benchmark `many_pyramids` with 20 × 20 × 10 and Box3D's with 14 × 14 × 10.
pub fn many(world: &mut World, rows: u32, columns: u32, base: u32) {
    set_conditions(world);
    let pitch = base as f32 + 1.0;
    let width = pitch * columns as f32;
    dim::spawn_pyramid_floors(world, rows, width, pitch);
    for row in 0..rows {
        for column in 0..columns {
            let x = (column as f32 + 0.5) * pitch - 0.5 * width;
            stack(world, base, dim::pyramid_row(row, rows, width, pitch).with_x(x));
        }
    }
}
