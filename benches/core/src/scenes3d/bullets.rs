//! Bullets fly through a city.

use std::f32::consts::TAU;

use crate::{
    dim3::{Body3, D3, Shape3, turn_about},
    random::Random,
    scene::{Plan, Scene},
};

/// How many streets the city has, along x.
const STREETS: usize = 100;
/// How many houses stand along a street.
const HOUSES: usize = 200;
/// From house to house, in metres.
const PLOT: f32 = 10.0;
/// From street to street, in metres.
const BLOCK: f32 = 20.0;
/// Height of the walls around the city, in metres. No bullet flies higher.
const WALL: f32 = 400.0;

pub(super) fn scene() -> Scene<D3> {
    let about = "1,000 balls and boxes of 5 cm at 50 to 400 m/s in the streets of 20,000 static houses";
    let mut scene = Scene::new(about, Plan::steps(60));
    let mut random = Random::new(7);
    let (width, depth) = (HOUSES as f32 * PLOT, STREETS as f32 * BLOCK);
    let ground = Shape3::Box(0.5 * width, 1.0, 0.5 * depth);
    scene.bodies.push(Body3::fixed([0.0, -1.0, 0.0], ground));
    for side in [-1.0, 1.0] {
        let (across, along) =
            (Shape3::Box(1.0, 0.5 * WALL, 0.5 * depth), Shape3::Box(0.5 * width, 0.5 * WALL, 1.0));
        scene.bodies.push(Body3::fixed([side * (0.5 * width + 1.0), 0.5 * WALL, 0.0], across));
        scene.bodies.push(Body3::fixed([0.0, 0.5 * WALL, side * (0.5 * depth + 1.0)], along));
    }
    for street in 0..STREETS {
        for house in 0..HOUSES {
            let half = [random.range(2.0, 4.0), random.range(1.0, 10.0), random.range(3.0, 5.0)];
            let x = (house as f32 + 0.5) * PLOT - 0.5 * width;
            let z = (street as f32 + 0.5) * BLOCK - 0.5 * depth;
            scene.bodies.push(Body3::fixed([x, half[1], z], Shape3::Box(half[0], half[1], half[2])));
        }
    }
    // Each starts between two rows of houses, and flies more along the ground than up or down.
    for i in 0..1000 {
        let street = 1 + i % (STREETS - 1);
        let at = [
            random.range(-0.49, 0.49) * width,
            random.range(1.0, 15.0),
            street as f32 * BLOCK - 0.5 * depth + random.range(-3.0, 3.0),
        ];
        let shape = if i % 2 == 0 { Shape3::Sphere(0.05) } else { Shape3::Box(0.05, 0.04, 0.05) };
        let ((sin, cos), speed) = (random.range(0.0, TAU).sin_cos(), random.range(50.0, 400.0));
        let up = random.range(-0.2, 0.2);
        let flat = speed * (1.0 - up * up).sqrt();
        let axis = [random.range(-1.0, 1.0), 1.1, random.range(-1.0, 1.0)];
        scene.bodies.push(Body3 {
            turn: turn_about(axis, random.range(0.0, TAU)),
            vel: [flat * cos, speed * up, flat * sin],
            spin: [0; 3].map(|_| random.range(-20.0, 20.0)),
            density: 1000.0,
            bullet: true,
            ..Body3::dynamic(at, shape)
        });
    }
    for body in &mut scene.bodies {
        (body.friction, body.restitution) = (0.2, 0.8);
    }
    scene.bounds = ([-0.5 * width, 0.0, -0.5 * depth], [0.5 * width, WALL, 0.5 * depth]);
    scene
}
