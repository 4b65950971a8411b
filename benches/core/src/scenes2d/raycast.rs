//! Rays through a field of shapes.

use crate::{
    dim2::{Body2, D2, Ray2, Shape2, V2},
    random::Random,
    scene::{Plan, Scene, Work},
};

/// Shapes per side of the field, one about every three metres.
const SIDE: i32 = 100;

pub(super) fn raycast() -> Scene<D2> {
    field("batches of 100,000 closest-hit rays of 50 m against 10,000 static shapes", Work::Raycasts)
}

pub(super) fn raycast_batch() -> Scene<D2> {
    field("the rays of raycast in one call per batch", Work::RaycastBatches)
}

fn field(about: &str, work: Work) -> Scene<D2> {
    let mut scene = Scene::new(about, Plan::batches(work, 7));
    let mut random = Random::new(11);
    for i in 0..SIDE {
        for j in 0..SIDE {
            let mut near = |n: i32| 3.0 * n as f32 + random.range(-1.0, 1.0);
            let at = [near(i), near(j)];
            let shape = match (i + j) % 3 {
                0 => Shape2::Circle(0.4),
                1 => Shape2::Box(0.4, 0.3),
                _ => Shape2::Capsule(0.3, 0.2),
            };
            scene.bodies.push(Body2 { turn: random.range(-3.0, 3.0), ..Body2::fixed(at, shape) });
        }
    }
    // Rays start outside of every shape: engines disagree on purpose about rays that do not.
    while scene.rays.len() < 100_000 {
        let angle = random.range(0.0, std::f32::consts::TAU);
        let origin = [random.range(0.0, 300.0), random.range(0.0, 300.0)];
        if !is_near_a_shape(&scene.bodies, origin) {
            scene.rays.push(Ray2 { origin, dir: [angle.cos(), angle.sin()], length: 50.0 });
        }
    }
    scene
}

fn is_near_a_shape(bodies: &[Body2], p: V2) -> bool {
    let cells = |x: f32| {
        let cell = (x / 3.0).floor() as i32;
        ((cell - 1).max(0))..=((cell + 2).min(SIDE - 1))
    };
    cells(p[0]).flat_map(|i| cells(p[1]).map(move |j| (i * SIDE + j) as usize)).any(|body| {
        let at = bodies[body].pos;
        (at[0] - p[0]).hypot(at[1] - p[1]) < 0.6
    })
}
