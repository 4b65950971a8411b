//! A wall is rammed.

use crate::{
    dim2::{Body2, D2, Shape2},
    scene::{Plan, Scene},
};

pub(super) fn scene() -> Scene<D2> {
    let about = "a heavy fast box hits a block of 9,600 touching small ones, no gravity, all awake";
    let mut scene = Scene::new(about, Plan::steps(250));
    scene.gravity = [0.0, 0.0];
    let ram = Body2::dynamic([-20.0, 0.0], Shape2::Box(4.0, 4.0));
    scene.bodies.push(Body2 { vel: [40.0, 0.0], density: 8.0, ..ram });
    let (side, columns, rows) = (0.4f32, 120, 80);
    for i in 0..columns {
        for j in 0..rows {
            let at = [i as f32 * side + 30.0, (j as f32 - rows as f32 / 2.0) * side];
            scene.bodies.push(Body2::dynamic(at, Shape2::Box(0.5 * side, 0.5 * side)));
        }
    }
    scene
}
