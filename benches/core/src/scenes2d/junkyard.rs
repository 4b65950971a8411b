//! A pusher ploughs through a heap.

use std::f32::consts::PI;

use crate::{
    dim2::{Body2, D2, Part2, Shape2},
    scene::{Drive, Plan, Scene},
    world::Kind,
};

pub(super) fn scene() -> Scene<D2> {
    let about = "8,000 pentagons fall into a yard, through which a kinematic box is pushed to and fro";
    let mut scene = Scene::new(about, Plan::settled(1, 799));
    scene.sleeping = true;
    let mut yard: Vec<Part2> =
        (-80..=80).map(|x| Part2::at([x as f32, 0.0], Shape2::Box(0.55, 0.5))).collect();
    for y in 1..=50 {
        yard.extend([-80.0, 80.0].map(|x| Part2::at([x, y as f32], Shape2::Box(0.5, 0.55))));
    }
    scene.bodies.push(Body2::compound(Kind::Static, [0.0, 0.0], yard));
    let pusher = vec![Part2::at([0.0, 4.0], Shape2::Box(2.0, 4.0))];
    scene.drive = Some(Drive { body: scene.bodies.len(), place: |t| [60.0 * (0.2 * t).sin(), 0.0] });
    scene.bodies.push(Body2::compound(Kind::Kinematic, [0.0, 0.0], pusher));
    // Each corner is the golden angle on from the last.
    let corner = |i: usize| {
        let (sin, cos) = (i as f32 * PI * (5.0_f32.sqrt() - 1.0)).sin_cos();
        [0.25 * cos, 0.25 * sin]
    };
    let junk = Shape2::Poly((0..5).map(corner).collect());
    let mut side = -0.1;
    for column in 0..200 {
        for row in 0..40 {
            side = -side;
            let at = [0.375 * (2.0 * column as f32 - 200.0) + side, row as f32 + 15.0];
            scene.bodies.push(Body2::dynamic(at, junk.clone()));
        }
    }
    scene.bounds = ([-80.5, -0.5], [80.5, 100.0]);
    scene
}
