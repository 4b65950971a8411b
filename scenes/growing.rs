//! Shapes that change while they touch: balls grow while they lie on each other.

use avian::prelude::*;
use bevy_app::FixedUpdate;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::Schedules;
use bevy_math::Vec3;

use crate::dim;
use crate::pile::{WIDTH, spawn_container};
use crate::scene::{at, set_conditions, spawn_body};

/// First and last radius of a ball in metres.
const RADII: (f32, f32) = (0.25, 0.5);
/// Growth of a radius in a step, in metres: 6 cm in a second.
const GROWTH: f32 = 0.001;

/// The radius of a ball.
#[derive(Component)]
struct Growing(f32);

/// Balls in a container, which grow.
pub fn growing(world: &mut World) {
    set_conditions(world);
    spawn_container(world, WIDTH, 14.0);
    let (across, deep) = dim::PILE_GRID;
    for i in 0..4 * across * deep {
        let (column, row, layer) = (i % across, i / across % deep, i / (across * deep));
        let cell = |i: u32, n: u32| (i as f32 + 0.5 - 0.5 * n as f32) * (WIDTH - 1.0) / across as f32;
        let shift = 0.2 * (layer % 2) as f32;
        let place = Vec3::new(cell(column, across) + shift, 0.5 + layer as f32, cell(row, deep) + shift);
        let place = place * dim::PLANE;
        spawn_body(world, RigidBody::Dynamic, dim::ball(RADII.0), at(place.x, place.y, place.z))
            .insert(Growing(RADII.0));
    }
    world.resource_mut::<Schedules>().add_systems(FixedUpdate, grow);
}

fn grow(mut balls: Query<(&mut Growing, &mut Collider)>) {
    for (mut growing, mut collider) in balls.iter_mut().filter(|(growing, _)| growing.0 < RADII.1) {
        growing.0 += GROWTH;
        *collider = dim::ball(growing.0);
    }
}
