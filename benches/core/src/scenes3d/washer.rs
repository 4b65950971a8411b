//! A round drum with paddles turns.

use std::sync::Arc;

use crate::{
    dim3::{Body3, D3, Part3, Shape3},
    scene::{Plan, Scene},
    scenes2d::drum_sections,
    world::Kind,
};

pub(super) fn scene() -> Scene<D3> {
    let about = "8,000 boxes in an open kinematic drum with four paddles";
    let mut scene = Scene::new(about, Plan::settled(1, 999));
    scene.sleeping = true;
    scene.bodies.push(Body3::fixed([0.0, -1.0, 0.0], Shape3::Box(60.0, 1.0, 60.0)));
    let long = |corners: [[f32; 2]; 4]| {
        let points = corners.iter().flat_map(|[x, y]| [-10.0, 10.0].map(|z| [*x, *y, z])).collect();
        Part3::at([0.0; 3], Shape3::Hull(Arc::new(points)))
    };
    let ring = drum_sections().into_iter().map(long).collect();
    let drum = Body3::compound(Kind::Kinematic, [0.0, 21.0, 0.0], ring);
    let spin = [0.0, 0.0, 25.0_f32.to_radians()];
    scene.bodies.push(Body3 { spin, vel: [0.001, -0.002, 0.0], ..drum });
    let place = |i: i32| 0.8 * (i as f32 - 9.5);
    for x in 0..20 {
        for y in 0..20 {
            for z in 0..20 {
                let at = [place(x), 21.0 + place(y), place(z)];
                let body = Body3::dynamic(at, Shape3::Box(0.2, 0.2, 0.2));
                scene.bodies.push(Body3 { density: 1000.0, ..body });
            }
        }
    }
    scene.bounds = ([-60.0, -0.5, -60.0], [60.0, 60.0, 60.0]);
    scene
}
