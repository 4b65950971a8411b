//! Rays and balls through a field of shapes.

use std::collections::HashMap;

use super::rock;
use crate::{
    dim3::{Body3, D3, Ray3, Shape3, V3, turn_about},
    random::Random,
    scene::{Plan, Scene, Work},
};

pub(super) fn raycast() -> Scene<D3> {
    let about = "batches of 100,000 closest-hit rays of 30 m against 10,000 static shapes";
    let mut scene = Scene::new(about, Plan::batches(Work::Raycasts, 7));
    add_field(&mut scene, 100_000);
    scene
}

pub(super) fn raycast_batch() -> Scene<D3> {
    let about = "the rays of raycast in one call per batch";
    let mut scene = Scene::new(about, Plan::batches(Work::RaycastBatches, 7));
    add_field(&mut scene, 100_000);
    scene
}

pub(super) fn ballcast() -> Scene<D3> {
    let about = "batches of 10,000 closest-hit sweeps of a sphere (0.25 m) over 30 m, same shapes";
    let mut scene = Scene::new(about, Plan::batches(Work::Ballcasts, 7));
    scene.cast_radius = 0.25;
    add_field(&mut scene, 10_000);
    scene
}

/// Shapes, one about every three metres, and where casts go.
fn add_field(scene: &mut Scene<D3>, casts: usize) {
    let mut random = Random::new(13);
    let rock = rock(0.5);
    let cells = (0..22).flat_map(|i| (0..21).flat_map(move |j| (0..22).map(move |k| (i, j, k))));
    for (i, j, k) in cells.take(10_000) {
        let mut near = |n: i32| 3.0 * n as f32 + random.range(-1.0, 1.0);
        let at = [near(i), near(j), near(k)];
        let shape = match (i + j + k) % 4 {
            0 => Shape3::Sphere(0.4),
            1 => Shape3::Box(0.4, 0.3, 0.5),
            2 => Shape3::Capsule(0.3, 0.2),
            _ => rock.clone(),
        };
        let axis = [random.range(-1.0, 1.0), 1.1, random.range(-1.0, 1.0)];
        let turn = turn_about(axis, random.range(-3.0, 3.0));
        scene.bodies.push(Body3 { turn, ..Body3::fixed(at, shape) });
    }
    // Casts start outside of every shape: engines disagree on purpose about those that do not.
    let grid = Grid::new(&scene.bodies);
    while scene.rays.len() < casts {
        let (angle, up) = (random.range(0.0, std::f32::consts::TAU), random.range(-1.0, 1.0));
        let flat = (1.0 - up * up).sqrt();
        let origin = [random.range(0.0, 66.0), random.range(0.0, 63.0), random.range(0.0, 66.0)];
        if !grid.has_near(origin) {
            let dir = [flat * angle.cos(), up, flat * angle.sin()];
            scene.rays.push(Ray3 { origin, dir, length: 30.0 });
        }
    }
}

/// Where shapes are, by cells of three metres.
struct Grid(HashMap<[i32; 3], Vec<V3>>);

impl Grid {
    fn new(bodies: &[Body3]) -> Self {
        let mut grid = HashMap::<_, Vec<V3>>::new();
        bodies.iter().for_each(|b| grid.entry(Self::cell(b.pos)).or_default().push(b.pos));
        Self(grid)
    }

    fn cell(p: V3) -> [i32; 3] {
        p.map(|x| (x / 3.0).floor() as i32)
    }

    fn has_near(&self, p: V3) -> bool {
        let [i, j, k] = Self::cell(p);
        let cells = (0..27).map(|n| [i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1]);
        cells
            .filter_map(|cell| self.0.get(&cell))
            .flatten()
            .any(|at| at.iter().zip(p).map(|(a, b)| (a - b) * (a - b)).sum::<f32>() < 1.1 * 1.1)
    }
}
