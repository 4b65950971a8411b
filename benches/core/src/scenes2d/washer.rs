//! A round drum with paddles turns.

use std::f32::consts::TAU;

use crate::{
    dim2::{Body2, D2, Part2, Shape2, V2},
    scene::{Plan, Scene},
    world::Kind,
};

pub(super) fn scene() -> Scene<D2> {
    let about = "8,100 small boxes in a kinematic drum with four paddles (no hit events)";
    let mut scene = Scene::new(about, Plan::settled(1, 499));
    scene.sleeping = true;
    let quad = |points| Part2::at([0.0; 2], Shape2::Poly(points));
    let ring = sections().into_iter().map(|corners| quad(corners.to_vec())).collect();
    let drum = Body2::compound(Kind::Kinematic, [0.0, 10.0], ring);
    scene.bodies.push(Body2 { spin: 25.0_f32.to_radians(), vel: [0.001, -0.002], ..drum });
    for i in 0..90 {
        for j in 0..90 {
            let at = [-9.9 + 0.21 * i as f32, 0.1 + 0.21 * j as f32];
            scene.bodies.push(Body2::dynamic(at, Shape2::Box(0.1, 0.1)));
        }
    }
    scene.bounds = ([-18.5, -8.5], [18.5, 28.5]);
    scene
}

/// Cross sections of the drum's segments, of ten degrees each and one more on either side, and
/// of its paddles.
pub(crate) fn sections() -> Vec<[V2; 4]> {
    let degree = TAU / 360.0;
    let quad = |inner: f32, outer: f32, from: f32, to: f32| {
        let at = |r: f32, angle: f32| [r * angle.cos(), r * angle.sin()];
        [at(inner, from), at(outer, from), at(outer, to), at(inner, to)]
    };
    let mut sections = Vec::new();
    for i in 0..36 {
        let (from, to) = (10.0 * i as f32 * degree, 10.0 * (i + 1) as f32 * degree);
        sections.push(quad(16.0, 18.0, from - degree, to + degree));
        if i % 9 == 0 {
            sections.push(quad(14.0, 16.0, from, to));
        }
    }
    sections
}
