//! Boxes fall into a container.

use super::light;
use crate::{
    dim3::{Body3, D3, Shape3, turn_about},
    random::Random,
    scene::{Plan, Scene},
};

pub(super) fn scene() -> Scene<D3> {
    let about = "3,024 boxes of half a metre, turned at random, fall into a container";
    let mut scene = Scene::new(about, Plan::steps(300));
    add_container(&mut scene.bodies, 4.0, 30.0);
    let mut random = Random::new(3);
    for y in 0..21 {
        for x in 0..12 {
            for z in 0..12 {
                let at = [-3.63 + 0.66 * x as f32, 0.6 + 0.75 * y as f32, -3.63 + 0.66 * z as f32];
                let axis = [random.range(-1.0, 1.0), random.range(-1.0, 1.0), 1.1];
                let turn = turn_about(axis, random.range(-0.25, 0.25));
                scene.bodies.push(Body3 { turn, ..light(at, Shape3::Box(0.25, 0.25, 0.25)) });
            }
        }
    }
    scene.bounds = ([-4.5, -0.5, -4.5], [4.5, 40.0, 4.5]);
    scene
}

/// Floor and four walls; `inner` is half of the free width.
fn add_container(bodies: &mut Vec<Body3>, inner: f32, height: f32) {
    let (thick, high) = (1.0, 0.5 * height);
    let wide = inner + 2.0 * thick;
    bodies.push(Body3::fixed([0.0, -thick, 0.0], Shape3::Box(wide, thick, wide)));
    for side in [-1.0, 1.0] {
        let away = side * (inner + thick);
        bodies.push(Body3::fixed([away, high, 0.0], Shape3::Box(thick, high, wide)));
        bodies.push(Body3::fixed([0.0, high, away], Shape3::Box(wide, high, thick)));
    }
}
