//! Round hulls of many corners fall in columns.

use std::sync::Arc;

use crate::{
    dim3::{Body3, D3, Shape3, V3},
    scene::{Plan, Scene},
};

pub(super) fn scene() -> Scene<D3> {
    let about = "5,120 hulls of 32 random points on a sphere of 2 m fall in columns of 80";
    let mut scene = Scene::new(about, Plan::settled(1, 499));
    scene.sleeping = true;
    scene.bodies.push(Body3::fixed([0.0, -1.0, 0.0], Shape3::Box(250.0, 1.0, 250.0)));
    let hull = Shape3::Hull(Arc::new(points()));
    for layer in 0..80 {
        for x in 0..8 {
            for z in 0..8 {
                let at = [(x as f32 - 4.0) * 4.0, 2.0 + 4.0 * layer as f32, (z as f32 - 4.0) * 4.0];
                scene.bodies.push(Body3 { density: 1000.0, ..Body3::dynamic(at, hull.clone()) });
            }
        }
    }
    scene.bounds = ([-250.0, -0.5, -250.0], [250.0, 400.0, 250.0]);
    scene
}

/// With the generator of Box3D's benchmark, so that it is the same hull.
fn points() -> Vec<V3> {
    let mut state = 42u32;
    let mut next = || {
        state = state.wrapping_mul(2_147_001_325).wrapping_add(715_136_305);
        (state & 0xffff) as f32 / 65_535.0 - 0.5
    };
    let mut points = Vec::new();
    while points.len() < 32 {
        let p = [next(), next(), next()];
        let squared: f32 = p.iter().map(|x| x * x).sum();
        if squared <= 0.25 {
            points.push(p.map(|x| 2.0 * x / squared.sqrt()));
        }
    }
    points
}
