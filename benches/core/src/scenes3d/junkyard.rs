//! A post ploughs through a heap.

use std::{
    f32::consts::{PI, TAU},
    sync::Arc,
};

use crate::{
    dim3::{Body3, D3, Shape3, V3},
    scene::{Drive, Plan, Scene},
    world::Kind,
};

pub(super) fn scene() -> Scene<D3> {
    let about = "10,584 rocks of ten corners fall into a yard, in which a kinematic post goes round";
    let mut scene = Scene::new(about, Plan::settled(1, 499));
    scene.sleeping = true;
    scene.bodies.push(Body3::fixed([0.0, -1.0, 0.0], Shape3::Box(120.0, 1.0, 120.0)));
    for side in [-50.0, 50.0] {
        scene.bodies.push(Body3::fixed([side, 7.0, 0.0], Shape3::Box(1.0, 8.0, 50.0)));
        scene.bodies.push(Body3::fixed([0.0, 7.0, side], Shape3::Box(50.0, 8.0, 1.0)));
    }
    scene.drive = Some(Drive { body: scene.bodies.len(), place });
    scene.bodies.push(Body3::new(Kind::Kinematic, place(0.0), Shape3::Hull(Arc::new(post()))));
    let rock = Shape3::Hull(Arc::new(rock()));
    for x in 0..21 {
        for y in 0..24 {
            for z in 0..21 {
                let at = [4.0 * x as f32 - 40.0, 4.0 * y as f32 + 25.0, 4.0 * z as f32 - 40.0];
                scene.bodies.push(Body3 { density: 1000.0, ..Body3::dynamic(at, rock.clone()) });
            }
        }
    }
    scene.bounds = ([-120.0, -0.5, -120.0], [120.0, 150.0, 120.0]);
    scene
}

/// Where the post is: on a circle of 35 m, going round by 6° a second.
fn place(time: f32) -> V3 {
    let (sin, cos) = (-6.0_f32.to_radians() * time).sin_cos();
    [35.0 * cos, 12.0, 35.0 * sin]
}

/// A prism of 16 sides, 24 m high and 4 m around.
fn post() -> Vec<V3> {
    let edge = |i: usize| (i as f32 * TAU / 16.0).sin_cos();
    let corners = (0..16).map(edge);
    corners.flat_map(|(sin, cos)| [-12.0, 12.0].map(|y| [4.0 * cos, y, 4.0 * sin])).collect()
}

/// Ten points spread over a sphere of 1.5 m along a golden spiral.
fn rock() -> Vec<V3> {
    let point = |i: usize| {
        let up = 1.0 - 2.0 * (i as f32 + 0.5) / 10.0;
        let flat = (1.0 - up * up).sqrt();
        let (sin, cos) = (i as f32 * PI * (3.0 - 5.0_f32.sqrt())).sin_cos();
        [1.5 * flat * cos, 1.5 * up, 1.5 * flat * sin]
    };
    (0..10).map(point).collect()
}
