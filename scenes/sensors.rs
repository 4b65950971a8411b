//! A sensor and its events: what enters the pool rises, what leaves it falls.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::dim;
use crate::pile::{WIDTH, spawn_container};
use crate::scene::{Glass, at, set_conditions, spawn_body};

/// A pool, and balls that bob at its surface.
pub fn pool(world: &mut World) {
    set_conditions(world);
    spawn_container(world, WIDTH, 14.0);
    spawn_body(world, RigidBody::Static, dim::block(WIDTH, 5.0, WIDTH), at(0.0, 2.5, 0.0))
        .insert((Sensor, CollisionEventsEnabled, Glass))
        .observe(rise)
        .observe(fall);
    let (across, deep) = dim::PILE_GRID;
    for i in 0..3 * across * deep {
        let (column, row, layer) = (i % across, i / across % deep, i / (across * deep));
        let cell = |i: u32, n: u32| (i as f32 + 0.5 - 0.5 * n as f32) * 1.4;
        let place = Vec3::new(cell(column, across), 6.0 + 1.4 * layer as f32, cell(row, deep)) * dim::PLANE;
        spawn_body(world, RigidBody::Dynamic, dim::ball(0.4), at(place.x, place.y, place.z))
            .insert((GravityScale(1.0), LinearDamping(0.2)));
    }
}

fn rise(event: On<CollisionStart>, mut scales: Query<&mut GravityScale>) {
    set(event.body2, &mut scales, -1.0);
}

fn fall(event: On<CollisionEnd>, mut scales: Query<&mut GravityScale>) {
    set(event.body2, &mut scales, 1.0);
}

fn set(body: Option<Entity>, scales: &mut Query<&mut GravityScale>, value: f32) {
    if let Some(mut scale) = body.and_then(|body| scales.get_mut(body).ok()) {
        scale.0 = value;
    }
}
