//! Stacks stay standing: row 16 of the required physics. 60 Hz, 4 substeps, sleeping off.

use avian::{math::Vector, prelude::*};
use bevy_ecs::prelude::*;
use scenes::{DT, SUBSTEPS, headless_app, pyramid, scene::at, towers};

use super::{dim, world::Lab};

/// Displacement of the top of a pyramid in `seconds` after six seconds of settling, and how far it
/// sagged before.
fn unrest_of_pyramid(base: u32, seconds: f64) -> (f32, f32) {
    let mut lab = Lab { app: headless_app(DT, SUBSTEPS), dt: DT };
    let boxes = pyramid::large(lab.app.world_mut(), base);
    let top = *boxes.last().expect("a pyramid has boxes");
    lab.seconds(6.0);
    let settled = lab.at(top);
    let sag = (settled - Vector::Y * (base as f32 - 0.5)).length();
    lab.seconds(seconds);
    let moved = (lab.at(top) - settled).length();
    println!(
        "pyramid of {base}: sagged {sag} m to {settled}, then moved {moved} m in {seconds} s to {}",
        lab.at(top)
    );
    (moved, sag)
}

#[test]
fn a_pyramid_of_base_64_stands() {
    let (moved, sag) = unrest_of_pyramid(64, 4.0);
    assert!(moved < dim::PYRAMID_UNREST, "the top moved {moved} m");
    assert!(sag < 0.5, "the top sagged {sag} m");
}

/// A quarter of the boxes. The larger one stands for a minute in tests/kernel/unrest.rs.
#[test]
fn a_pyramid_of_base_32_stands_for_a_quarter_of_a_minute() {
    let (moved, sag) = unrest_of_pyramid(32, 15.0);
    assert!(moved < dim::PYRAMID_UNREST, "the top moved {moved} m");
    assert!(sag < 0.25, "the top sagged {sag} m");
}

/// Lets towers of boxes stand for twenty seconds, and compares the positions of their tops.
fn towers_stand(heights: &[u32]) {
    let mut lab = Lab { app: headless_app(DT, SUBSTEPS), dt: DT };
    towers::towers(lab.app.world_mut(), heights);
    let world = lab.app.world_mut();
    let mut bodies = world.query_filtered::<Entity, With<RigidBody>>();
    for body in bodies.iter(world).collect::<Vec<_>>() {
        world.entity_mut(body).insert(SleepingDisabled);
    }
    let tops: Vec<(Entity, bevy_math::Vec3)> =
        world.query::<(Entity, &scenes::Watched)>().iter(world).map(|(e, w)| (e, w.0)).collect();
    assert_eq!(tops.len(), heights.len());
    lab.seconds(20.0);
    for (top, start) in tops {
        let p = lab.at(top);
        println!("tower of {}: top at {p:?}", start.y + 0.5);
        assert!((p.x - start.x).abs() < 0.1 && p.y > 0.97 * start.y, "from {start:?} to {p:?}");
    }
}

#[test]
fn towers_of_10_20_and_50_boxes_stand() {
    towers_stand(&[10, 20, 50]);
}

#[test]
fn a_tower_of_100_boxes_stands() {
    towers_stand(&[100]);
}

#[test]
fn a_tower_of_balls_stands() {
    let mut lab = Lab::new();
    lab.floor();
    let balls: Vec<Entity> = (0..10).map(|i| lab.ball(0.5, at(0.0, 0.5 + i as f32, 0.0))).collect();
    for &ball in &balls {
        lab.insert(ball, SleepingDisabled);
    }
    lab.seconds(10.0);
    for (i, &ball) in balls.iter().enumerate() {
        let p = lab.at(ball);
        assert!((p - Vector::Y * (0.5 + i as f32)).length() < 0.05, "ball {i} is at {p:?}");
    }
}

#[test]
fn a_heap_of_balls_comes_to_rest() {
    let mut lab = Lab::new();
    scenes::pile::spawn_container(lab.app.world_mut(), 4.0, 30.0);
    let balls: Vec<Entity> = (0..60)
        .map(|i| {
            let (x, y) = ((i % 3) as f32 * 1.1 - 1.1, (i / 3) as f32 * 1.05 + 0.6);
            lab.ball(0.5, at(x + 0.05 * (i / 3 % 2) as f32, y, 0.0))
        })
        .collect();
    lab.seconds(20.0);
    let fastest = balls.iter().map(|&b| lab.velocity(b).length()).fold(0.0, f32::max);
    println!(
        "fastest ball {fastest} m/s, {} asleep",
        balls.iter().filter(|&&b| lab.has::<Sleeping>(b)).count()
    );
    assert!(fastest < 0.1, "still at {fastest} m/s");
}
