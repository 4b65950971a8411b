//! A bridge, ragdolls and cars.

use crate::{
    dim2::{Body2, D2, Joint2, Shape2, V2},
    random::Random,
    scene::{Plan, Scene},
};

/// Planks of a metre between two pillars, with boxes on them.
pub(super) fn bridge() -> Scene<D2> {
    let mut scene = Scene::new("20 bridges of 200 planks each, with ten boxes on each", Plan::steps(300));
    for k in 0..20 {
        let height = 15.0 * k as f32;
        let pillars = [-1.0, 200.0].map(|x| {
            scene.bodies.push(Body2::fixed([x, height], Shape2::Box(0.5, 0.5)));
            scene.bodies.len() - 1
        });
        let mut last = pillars[0];
        for i in 0..200 {
            let plank = Body2::dynamic([i as f32, height], Shape2::Box(0.5, 0.125));
            scene.bodies.push(Body2 { density: 20.0, ..plank });
            let me = scene.bodies.len() - 1;
            scene.joints.push(Joint2::free([last, me], [[0.5, 0.0], [-0.5, 0.0]]));
            last = me;
        }
        scene.joints.push(Joint2::free([last, pillars[1]], [[0.5, 0.0], [-0.5, 0.0]]));
        for i in 0..10 {
            let at = [15.0 + 18.0 * i as f32, height + 1.0];
            scene.bodies.push(Body2 { density: 20.0, ..Body2::dynamic(at, Shape2::Box(0.5, 0.5)) });
        }
    }
    scene.bounds = ([-50.0, -300.0], [250.0, 400.0]);
    scene
}

/// The limbs of a ragdoll: half length and radius of each capsule along x, where its middle is, and how
/// it is turned.
const LIMBS: [(f32, f32, V2, f32); 10] = [
    (0.2, 0.12, [0.0, 0.0], 90.0),
    (0.05, 0.11, [0.0, 0.45], 90.0),
    (0.12, 0.05, [-0.32, 0.2], 0.0),
    (0.12, 0.05, [-0.62, 0.2], 0.0),
    (0.12, 0.05, [0.32, 0.2], 0.0),
    (0.12, 0.05, [0.62, 0.2], 0.0),
    (0.15, 0.06, [-0.1, -0.5], 90.0),
    (0.15, 0.06, [-0.1, -0.9], 90.0),
    (0.15, 0.06, [0.1, -0.5], 90.0),
    (0.15, 0.06, [0.1, -0.9], 90.0),
];

/// The joints of a ragdoll: two limbs, the point, and how far it turns either way, in degrees.
const JOINTS: [(usize, usize, V2, f32); 9] = [
    (0, 1, [0.0, 0.3], 30.0),
    (0, 2, [-0.15, 0.2], 90.0),
    (2, 3, [-0.47, 0.2], 75.0),
    (0, 4, [0.15, 0.2], 90.0),
    (4, 5, [0.47, 0.2], 75.0),
    (0, 6, [-0.1, -0.3], 45.0),
    (6, 7, [-0.1, -0.7], 60.0),
    (0, 8, [0.1, -0.3], 45.0),
    (8, 9, [0.1, -0.7], 60.0),
];

/// Ragdolls fall into a box.
pub(super) fn ragdolls() -> Scene<D2> {
    let mut scene =
        Scene::new("400 ragdolls of ten capsules, with limits, fall into a bin", Plan::steps(600));
    for (at, shape) in [([0.0, -1.0], (21.0, 1.0)), ([-21.0, 50.0], (1.0, 52.0)), ([21.0, 50.0], (1.0, 52.0))]
    {
        scene.bodies.push(Body2::fixed(at, Shape2::Box(shape.0, shape.1)));
    }
    let mut random = Random::new(1);
    for i in 0..400 {
        let at = [-18.0 + 2.0 * (i % 19) as f32 + random.range(-0.2, 0.2), 2.0 + 2.2 * (i / 19) as f32];
        let first = scene.bodies.len();
        for (half, radius, place, turn) in LIMBS {
            let limb = Body2::dynamic([at[0] + place[0], at[1] + place[1]], Shape2::Capsule(half, radius));
            scene.bodies.push(Body2 { turn: turn.to_radians(), density: 20.0, ..limb });
        }
        for (a, b, point, limit) in JOINTS {
            let local = |limb: usize| {
                let (_, _, place, turn) = LIMBS[limb];
                let ([x, y], (s, c)) =
                    ([point[0] - place[0], point[1] - place[1]], turn.to_radians().sin_cos());
                [c * x + s * y, c * y - s * x]
            };
            let rest = (LIMBS[b].3 - LIMBS[a].3).to_radians();
            let limits = Some([-limit, limit].map(|limit| rest + limit.to_radians()));
            let (anchor_a, anchor_b) = (local(a), local(b));
            scene.joints.push(Joint2 { a: first + a, b: first + b, anchor_a, anchor_b, limits });
        }
    }
    scene.bounds = ([-22.0, -2.0], [22.0, 110.0]);
    scene
}

/// Cars roll down a slope of a thousand steps, each of a box and two wheels.
pub(super) fn cars() -> Scene<D2> {
    let mut scene = Scene::new("500 cars of a box on two wheels roll down hills", Plan::steps(300));
    let hill = |x: f32| -0.1 * x + 1.5 * (0.2 * x).sin();
    for i in 0..1500 {
        let (x, next) = (2.0 * i as f32, 2.0 * (i + 1) as f32);
        let (low, high) = (hill(x), hill(next));
        let piece = vec![[0.0, 0.0], [2.0, high - low], [2.0, high - low - 1.0], [0.0, -1.0]];
        scene.bodies.push(Body2::fixed([x, low], Shape2::Poly(piece)));
    }
    for i in 0..500 {
        let x = 10.0 + 5.0 * i as f32;
        let height = [-0.8, 0.8].map(|along| hill(x + along)).into_iter().fold(f32::MIN, f32::max) + 0.5;
        let first = scene.bodies.len();
        scene.bodies.push(Body2::dynamic([x, height + 0.35], Shape2::Box(1.2, 0.25)));
        for (k, along) in [-0.8, 0.8].into_iter().enumerate() {
            scene.bodies.push(Body2::dynamic([x + along, height], Shape2::Circle(0.4)));
            scene.joints.push(Joint2::free([first, first + 1 + k], [[along, -0.35], [0.0, 0.0]]));
        }
    }
    scene.bounds = ([-10.0, -400.0], [3100.0, 50.0]);
    scene
}
