//! A rotating kinematic drum of child colliders, full of small boxes that never come to rest.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::dim;
use crate::scene::{Glass, at, set_conditions, spawn_body};

/// The drum's turning speed in rad/s: 25 degrees.
pub const SPEED: f32 = 0.436_332_3;

/// A square drum around (0, 10) with `side` × `side` boxes in it (times [`dim::TUMBLER_DEPTH`] in 3D).
/// Returns the drum.
pub fn tumbler(world: &mut World, side: u32) -> Entity {
    set_conditions(world);
    let depth = dim::TUMBLER_SPACE;
    let mut drum = world.spawn((RigidBody::Kinematic, at(0.0, 10.0, 0.0), dim::spin(SPEED)));
    drum.with_children(|walls| {
        for (x, y, width, height) in
            [(10.0, 0.0, 1.0, 20.0), (-10.0, 0.0, 1.0, 20.0), (0.0, 10.0, 20.0, 1.0), (0.0, -10.0, 20.0, 1.0)]
        {
            walls.spawn((dim::block(width, height, depth), at(x, y, 0.0)));
        }
        for (z, glass) in dim::walls_across(0.5 * depth + 0.5) {
            let mut wall = walls.spawn((dim::block(21.0, 21.0, 1.0), at(0.0, 0.0, z)));
            if glass {
                wall.insert(Glass);
            }
        }
    });
    let drum = drum.id();

    let (size, pitch) = dim::TUMBLER_BOX;
    let from = |n: u32| -0.5 * pitch * (n as f32 - 1.0);
    for layer in 0..dim::TUMBLER_DEPTH {
        for row in 0..side {
            for column in 0..side {
                let offset = Vec3::new(column as f32, row as f32, layer as f32) * pitch;
                let start = Vec3::new(from(side), 10.0 + from(side), from(dim::TUMBLER_DEPTH));
                let place = (start + offset) * dim::PLANE;
                spawn_body(
                    world,
                    RigidBody::Dynamic,
                    dim::block(size, size, size),
                    at(place.x, place.y, place.z),
                );
            }
        }
    }
    drum
}
