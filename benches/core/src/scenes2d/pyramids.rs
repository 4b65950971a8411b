//! One large pyramid, and many small ones.

use super::add_pyramid;
use crate::{
    dim2::{Body2, D2, Shape2},
    scene::{Plan, Scene},
};

pub(super) fn large() -> Scene<D2> {
    let mut scene = Scene::new("one pyramid of unit boxes with a base of 100", Plan::steps(200));
    scene.bodies.push(Body2::fixed([0.0, -1.0], Shape2::Box(100.0, 1.0)));
    scene.watch = Some(add_pyramid(&mut scene.bodies, 100, [-50.0, 0.0]));
    scene.bounds = ([-60.0, -1.0], [60.0, 110.0]);
    scene
}

pub(super) fn many() -> Scene<D2> {
    let about = "20 x 8 pyramids with a base of 10 on eight long floors (Box2D's has 20 x 20)";
    let mut scene = Scene::new(about, Plan::steps(200));
    add_field(&mut scene, 20, 8);
    scene
}

/// Small pyramids, however many.
pub(super) fn field(columns: usize, rows: usize) -> Scene<D2> {
    let mut scene = Scene::new(format!("{columns} x {rows} pyramids with a base of 10"), Plan::steps(60));
    add_field(&mut scene, columns, rows);
    scene
}

/// Rows of pyramids with a base of 10, each row on a long floor.
pub(super) fn add_field(scene: &mut Scene<D2>, columns: usize, rows: usize) {
    const BASE: usize = 10;
    let pitch = BASE as f32 + 1.0;
    let half_width = 0.5 * pitch * columns as f32;
    for row in 0..rows {
        let floor = row as f32 * pitch;
        scene.bodies.push(Body2::fixed([0.0, floor - 0.25], Shape2::Box(half_width + 1.0, 0.25)));
        for column in 0..columns {
            let left = -half_width + column as f32 * pitch + 0.5;
            scene.watch = Some(add_pyramid(&mut scene.bodies, BASE, [left, floor]));
        }
    }
    scene.bounds = ([-half_width - 1.0, -1.0], [half_width + 1.0, rows as f32 * pitch]);
}
