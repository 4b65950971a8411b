//! Sensors change nothing: bodies have the same bits with and without them.

use super::dim::{sized, turned};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::{BodyKind, BodyPose, Velocity};

/// When sensors are added.
#[derive(Clone, Copy, Debug, PartialEq)]
enum When {
    Never,
    /// Before all bodies, so that ids are others.
    First,
    /// After all bodies.
    Last,
    /// In the middle of the run.
    Later,
    /// After all bodies. They are removed in the middle of the run.
    ForAWhile,
}

/// A sensor around all, one that bodies leave and enter, and one far away.
fn add_sensors(sim: &mut Sim) -> Vec<u32> {
    let at = [(40.0, 0.0), (1.5, 2.0), (1.0, -400.0)];
    let add = |(half, y)| {
        let shape = Shape::Cuboid(Cuboid { half: Vector::ONE * half });
        sim.add_sensor(shape, Vector::Y * y)
    };
    at.map(add).to_vec()
}

/// Boxes and balls that fall onto each other, are hit, and fall asleep.
fn run(when: When, workers: usize) -> Vec<(BodyPose, Velocity)> {
    let mut sim = Sim::new();
    sim.set_workers(workers);
    sim.sleeping = true;
    let mut sensors = if when == When::First { add_sensors(&mut sim) } else { Vec::new() };
    sim.floor();
    let mut bodies = Vec::new();
    for i in 0..90 {
        let at = sized(1.02 * (i % 6) as f32 - 2.5, 0.7 + 1.15 * (i / 6) as f32, 0.01 * (i % 7) as f32);
        let shape = match i % 3 {
            0 => Shape::Ball(Ball { radius: 0.45 }),
            _ => Shape::Cuboid(Cuboid { half: Vector::ONE * 0.45 }),
        };
        bodies.push(sim.add(BodyKind::Dynamic, shape, at, turned(0.3 * i as f32)));
    }
    if matches!(when, When::Last | When::ForAWhile) {
        sensors = add_sensors(&mut sim);
    }
    sim.steps(70);
    if when == When::Later {
        add_sensors(&mut sim);
    }
    if when == When::ForAWhile {
        sensors.into_iter().for_each(|sensor| sim.remove(sensor));
    }
    for round in 0..3 {
        let shape = Shape::Ball(Ball { radius: 0.6 });
        let ball = sim.add(BodyKind::Dynamic, shape, sized(-12.0, 1.0 + round as f32, 0.0), Rot::IDENTITY);
        sim.bodies.set_velocity(ball, Velocity { linear: Vector::X * 30.0, ..Velocity::default() });
        bodies.push(ball);
        sim.steps(60);
    }
    sim.steps(200);
    bodies.iter().map(|id| (sim.bodies.poses[*id as usize], sim.bodies.velocities[*id as usize])).collect()
}

#[test]
fn issue_a_sensor_changed_the_bits_of_others() {
    let alone = run(When::Never, 1);
    for when in [When::First, When::Last, When::Later, When::ForAWhile] {
        for workers in [1, 4] {
            let with = run(when, workers);
            let differ = alone.iter().zip(&with).filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "of {} bodies, {when:?}, {workers} workers", alone.len());
        }
    }
}
