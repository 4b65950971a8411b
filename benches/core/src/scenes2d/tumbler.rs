//! A square drum turns.

use crate::{
    dim2::{Body2, D2, Part2, Shape2},
    scene::{Plan, Scene},
    world::Kind,
};

pub(super) fn scene() -> Scene<D2> {
    let about = "2,025 small boxes in a kinematic square drum that turns 25 degrees a second";
    let mut scene = Scene::new(about, Plan::settled(65, 300));
    let walls = vec![
        Part2::at([10.0, 0.0], Shape2::Box(0.5, 10.0)),
        Part2::at([-10.0, 0.0], Shape2::Box(0.5, 10.0)),
        Part2::at([0.0, 10.0], Shape2::Box(10.0, 0.5)),
        Part2::at([0.0, -10.0], Shape2::Box(10.0, 0.5)),
    ];
    let drum = Body2::compound(Kind::Kinematic, [0.0, 10.0], walls);
    scene.bodies.push(Body2 { spin: 25.0_f32.to_radians(), ..drum });
    let n = 45;
    for i in 0..n {
        for j in 0..n {
            let x = -0.2 * n as f32 + 0.4 * j as f32;
            let y = 10.0 - 0.2 * n as f32 + 0.4 * i as f32;
            scene.bodies.push(Body2::dynamic([x, y], Shape2::Box(0.125, 0.125)));
        }
    }
    scene.bounds = ([-15.0, -5.0], [15.0, 25.0]);
    scene
}
