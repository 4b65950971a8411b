//! The cost of a world at rest: static or sleeping bodies, compared with the same `App` without physics.
//! without physics.

use std::time::Instant;

use bevy_app::{App, TaskPoolPlugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::{TransformPlugin, components::Transform};

use super::{avian::prelude::*, scenes};

/// Number of timed steps.
const TIMED: usize = 200;
/// Number of steps after which everything sleeps.
const SETTLE: usize = 120;

/// One line per mix of static and resting boxes: milliseconds per step, and the number of awake bodies.
pub fn report() {
    for (fixed, resting) in [(0, 0), (20_000, 1_000), (100_000, 0), (50_000, 50_000)] {
        let mut app = scenes::headless_app(scenes::DT, scenes::SUBSTEPS);
        let boxes = spawn(app.world_mut(), fixed, resting, |world, resting, at| {
            let body = if resting { RigidBody::Dynamic } else { RigidBody::Static };
            world.spawn((body, scenes::dim::block(0.8, 0.8, 0.8), Transform::from_translation(at)));
        });
        (0..SETTLE).for_each(|_| scenes::step(&mut app));
        let with = median(&mut app);
        let mut bodies = app.world_mut().query_filtered::<&RigidBody, Without<Sleeping>>();
        let awake = bodies.iter(app.world()).filter(|body| body.is_dynamic()).count();

        let mut bare = App::new();
        bare.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin));
        bare.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
        bare.finish();
        bare.cleanup();
        spawn(bare.world_mut(), fixed, resting, |world, _, at| {
            world.spawn(Transform::from_translation(at));
        });
        (0..SETTLE).for_each(|_| bare.update());
        let without = median(&mut bare);
        println!(
            "{fixed:>7} static {resting:>6} resting: {with:.3} ms a step, without physics {without:.3} ms, {awake} of {boxes} awake"
        );
    }
}

/// A floor of static boxes, each with or without a box at rest on it.
fn spawn(
    world: &mut World,
    fixed: usize,
    resting: usize,
    mut add: impl FnMut(&mut World, bool, Vec3),
) -> usize {
    for i in 0..fixed.max(resting) {
        let at = Vec3::new((i % 1000) as f32 * 1.5, (i / 1000) as f32 * 4.0, 0.0);
        if i < fixed {
            add(world, false, at);
        }
        if i < resting {
            add(world, true, at + Vec3::Y * 0.8);
        }
    }
    fixed + resting
}

fn median(app: &mut App) -> f64 {
    let mut times: Vec<f64> = (0..TIMED)
        .map(|_| {
            let start = Instant::now();
            app.update();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[TIMED / 2]
}
