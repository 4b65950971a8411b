//! One large pyramid, and many small ones.

use super::add_pyramid;
use crate::{
    dim3::{Body3, D3, Shape3},
    scene::{Plan, Scene},
};

pub(super) fn large() -> Scene<D3> {
    let about = "one flat pyramid of unit boxes with a base of 50 (Box3D's has 100)";
    let mut scene = Scene::new(about, Plan::steps(200));
    scene.bodies.push(Body3::fixed([0.0, -1.0, 0.0], Shape3::Box(100.0, 1.0, 100.0)));
    scene.watch = Some(add_pyramid(&mut scene.bodies, 50, -25.0, 0.0));
    scene.bounds = ([-30.0, -1.0, -5.0], [30.0, 60.0, 5.0]);
    scene
}

pub(super) fn many() -> Scene<D3> {
    let about = "10 x 10 flat pyramids with a base of 10 (Box3D's has 14 x 14)";
    let mut scene = Scene::new(about, Plan::steps(150));
    add_field(&mut scene, 10, 10);
    scene
}

/// Small pyramids, however many.
pub(super) fn field(columns: usize, rows: usize) -> Scene<D3> {
    let mut scene = Scene::new(format!("{columns} x {rows} pyramids with a base of 10"), Plan::steps(60));
    add_field(&mut scene, columns, rows);
    scene
}

/// Rows of flat pyramids with a base of 10 on one floor.
pub(super) fn add_field(scene: &mut Scene<D3>, columns: usize, rows: usize) {
    const BASE: usize = 10;
    let pitch = BASE as f32 + 1.0;
    let half = |n: usize| 0.5 * pitch * n as f32;
    let (x, z) = (half(columns) + 5.0, half(rows) + 5.0);
    scene.bodies.push(Body3::fixed([0.0, -1.0, 0.0], Shape3::Box(x, 1.0, z)));
    for row in 0..rows {
        for column in 0..columns {
            let left = 0.5 - half(columns) + pitch * column as f32;
            let depth = 0.5 * pitch - half(rows) + pitch * row as f32;
            scene.watch = Some(add_pyramid(&mut scene.bodies, BASE, left, depth));
        }
    }
    scene.bounds = ([-x, -1.0, -z], [x, 15.0, z]);
}
