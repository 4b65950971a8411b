//! Ragdolls fall into a bin.

use super::light;
use crate::{
    dim3::{Body3, D3, Joint3, Shape3, V3},
    random::Random,
    scene::{Plan, Scene},
};

/// The limbs: half length and radius of each capsule along y, and where its middle is.
const LIMBS: [(f32, f32, V3); 10] = [
    (0.2, 0.12, [0.0, 0.0, 0.0]),
    (0.05, 0.11, [0.0, 0.45, 0.0]),
    (0.12, 0.05, [-0.24, 0.05, 0.0]),
    (0.12, 0.05, [-0.24, -0.3, 0.0]),
    (0.12, 0.05, [0.24, 0.05, 0.0]),
    (0.12, 0.05, [0.24, -0.3, 0.0]),
    (0.15, 0.06, [-0.1, -0.5, 0.0]),
    (0.15, 0.06, [-0.1, -0.9, 0.0]),
    (0.15, 0.06, [0.1, -0.5, 0.0]),
    (0.15, 0.06, [0.1, -0.9, 0.0]),
];

/// The joints: two limbs, the point, and the limits of cone and twist, in degrees.
const JOINTS: [(usize, usize, V3, [f32; 2]); 9] = [
    (0, 1, [0.0, 0.3, 0.0], [30.0, 40.0]),
    (0, 2, [-0.24, 0.2, 0.0], [80.0, 30.0]),
    (2, 3, [-0.24, -0.125, 0.0], [70.0, 5.0]),
    (0, 4, [0.24, 0.2, 0.0], [80.0, 30.0]),
    (4, 5, [0.24, -0.125, 0.0], [70.0, 5.0]),
    (0, 6, [-0.1, -0.3, 0.0], [50.0, 20.0]),
    (6, 7, [-0.1, -0.7, 0.0], [60.0, 5.0]),
    (0, 8, [0.1, -0.3, 0.0], [50.0, 20.0]),
    (8, 9, [0.1, -0.7, 0.0], [60.0, 5.0]),
];

pub(super) fn scene() -> Scene<D3> {
    let mut scene =
        Scene::new("400 ragdolls of ten capsules, with limits, fall into a bin", Plan::steps(400));
    scene.bodies.push(Body3::fixed([0.0, -1.0, 0.0], Shape3::Box(12.0, 1.0, 12.0)));
    for (x, z) in [(-6.0, 0.0), (6.0, 0.0), (0.0, -6.0), (0.0, 6.0)] {
        let half = if z == 0.0 { [0.5, 7.0] } else { [7.0, 0.5] };
        scene.bodies.push(Body3::fixed([x, 30.0, z], Shape3::Box(half[0], 30.0, half[1])));
    }
    let mut random = Random::new(1);
    for i in 0..400 {
        let (column, row, layer) = (i % 5, i / 5 % 5, i / 25);
        let aside = [random.range(-0.2, 0.2), random.range(-0.2, 0.2)];
        let at = [
            2.0 * (column as f32 - 2.0) + aside[0],
            2.0 + 2.2 * layer as f32,
            2.0 * (row as f32 - 2.0) + aside[1],
        ];
        let first = scene.bodies.len();
        for (half, radius, [x, y, z]) in LIMBS {
            let at = [at[0] + x, at[1] + y, at[2] + z];
            scene.bodies.push(light(at, Shape3::Capsule(half, radius)));
        }
        for (a, b, point, limits) in JOINTS {
            let local = |limb: usize| core::array::from_fn(|k| point[k] - LIMBS[limb].2[k]);
            let limits = Some(limits.map(f32::to_radians));
            let (anchor_a, anchor_b) = (local(a), local(b));
            scene.joints.push(Joint3 { a: first + a, b: first + b, anchor_a, anchor_b, limits });
        }
    }
    scene.bounds = ([-7.0, -2.0, -7.0], [7.0, 60.0, 7.0]);
    scene
}
