//! Bullets fly through a city.

use std::f32::consts::TAU;

use crate::{
    dim2::{Body2, D2, Shape2},
    random::Random,
    scene::{Plan, Scene},
};

/// How many streets lie one above the other, each with a ground of its own.
const STREETS: usize = 100;
/// How many houses a street has.
const HOUSES: usize = 200;
/// From house to house, in metres.
const PLOT: f32 = 9.0;
/// From ground to ground, in metres.
const STOREY: f32 = 30.0;

pub(super) fn scene() -> Scene<D2> {
    let about = "1,000 discs and boxes of 5 cm at 50 to 400 m/s among 20,000 static houses, in streets one above the other";
    let mut scene = Scene::new(about, Plan::steps(60));
    let mut random = Random::new(7);
    let (width, height) = (HOUSES as f32 * PLOT, STREETS as f32 * STOREY);
    let ground = |street: usize| street as f32 * STOREY - 0.5 * height;
    for street in 0..=STREETS {
        let slab = Shape2::Box(0.5 * width, 0.5);
        scene.bodies.push(Body2::fixed([0.0, ground(street) - 0.5], slab));
    }
    for side in [-1.0, 1.0] {
        let wall = Shape2::Box(1.0, 0.5 * height + 1.0);
        scene.bodies.push(Body2::fixed([side * (0.5 * width + 1.0), 0.0], wall));
    }
    for street in 0..STREETS {
        for house in 0..HOUSES {
            let (half_width, half_height) = (random.range(1.5, 3.0), random.range(1.0, 10.0));
            let x = (house as f32 + 0.5) * PLOT - 0.5 * width;
            let at = [x, ground(street) + half_height];
            scene.bodies.push(Body2::fixed(at, Shape2::Box(half_width, half_height)));
        }
    }
    // Each starts in a gap between two houses, below or above their roofs.
    for i in 0..1000 {
        let gap = 1 + (random.unit() * (HOUSES - 1) as f32) as usize;
        let x = gap as f32 * PLOT - 0.5 * width + random.range(-1.0, 1.0);
        let at = [x, ground(i % STREETS) + random.range(1.0, 29.0)];
        let shape = if i % 2 == 0 { Shape2::Circle(0.05) } else { Shape2::Box(0.05, 0.04) };
        let ((sin, cos), speed) = (random.range(0.0, TAU).sin_cos(), random.range(50.0, 400.0));
        scene.bodies.push(Body2 {
            turn: random.range(0.0, TAU),
            vel: [speed * cos, speed * sin],
            spin: random.range(-20.0, 20.0),
            density: 1000.0,
            bullet: true,
            ..Body2::dynamic(at, shape)
        });
    }
    for body in &mut scene.bodies {
        (body.friction, body.restitution) = (0.2, 0.8);
    }
    let corner = [0.5 * width, 0.5 * height];
    scene.bounds = (corner.map(|x| -x), corner);
    scene
}
