//! Queries and forces: every two seconds what is near the middle is found and pushed away.

use avian::prelude::*;
use bevy_app::FixedUpdate;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::Schedules;
use bevy_math::Vec3;

use crate::dim;
use crate::pile::{WIDTH, spawn_container};
use crate::scene::{at, set_conditions, spawn_body};

/// Radius of a blast in metres.
const RADIUS: f32 = 3.0;
/// The largest change of velocity by a blast, in m/s.
const PUSH: f32 = 9.0;
/// Steps between two blasts.
const PERIOD: u32 = 120;

/// A heap of boxes between walls that is blown apart again and again.
pub fn blasts(world: &mut World) {
    set_conditions(world);
    spawn_container(world, WIDTH, 14.0);
    let (across, deep) = dim::PILE_GRID;
    for i in 0..4 * across * deep {
        let (column, row, layer) = (i % across, i / across % deep, i / (across * deep));
        let cell = |i: u32, n: u32| i as f32 + 0.5 - 0.5 * n as f32;
        let place = Vec3::new(cell(column, across), 0.4 + layer as f32, cell(row, deep)) * dim::PLANE;
        spawn_body(world, RigidBody::Dynamic, dim::block(0.8, 0.8, 0.8), at(place.x, place.y, place.z));
    }
    world.resource_mut::<Schedules>().add_systems(FixedUpdate, blast);
}

fn blast(queries: SpatialQuery, mut bodies: Query<(&RigidBody, Forces)>, mut step: Local<u32>) {
    *step += 1;
    if !step.is_multiple_of(PERIOD) {
        return;
    }
    let center = dim::upwards(0.5);
    let filter = SpatialQueryFilter::default();
    for entity in queries.shape_intersections(&dim::ball(RADIUS), center, dim::NO_TURN, &filter) {
        let Ok((RigidBody::Dynamic, mut body)) = bodies.get_mut(entity) else { continue };
        let away = body.position().0 - center;
        let nearness = (1.0 - away.length() / RADIUS).max(0.0);
        *body.linear_velocity_mut() += away.normalize_or_zero() * PUSH * nearness;
    }
}
