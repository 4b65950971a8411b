//! All kinds of shapes fall on hills.

use std::sync::Arc;

use super::{light, rock};
use crate::{
    dim3::{Body3, D3, Mesh, Shape3, turn_about},
    random::Random,
    scene::{Plan, Scene},
};

pub(super) fn scene() -> Scene<D3> {
    let about = "1,024 boxes, rocks, capsules and spheres fall on a hilly mesh of 20,000 triangles";
    let mut scene = Scene::new(about, Plan::steps(300));
    scene.bodies.push(Body3::fixed([0.0; 3], Shape3::Mesh(Arc::new(hills()))));
    let mut random = Random::new(9);
    let rock = rock(0.5);
    for i in 0..32 {
        for j in 0..32 {
            let (x, z) = (2.5 * (i as f32 - 15.5), 2.5 * (j as f32 - 15.5));
            let shape = match (i + 2 * j) % 4 {
                0 => Shape3::Box(0.4, 0.4, 0.4),
                1 => rock.clone(),
                2 => Shape3::Capsule(0.3, 0.3),
                _ => Shape3::Sphere(0.45),
            };
            let at = [x, 4.0 + random.range(0.0, 1.5), z];
            let axis = [random.range(-1.0, 1.0), 1.1, random.range(-1.0, 1.0)];
            let turn = turn_about(axis, random.range(-2.0, 2.0));
            scene.bodies.push(Body3 { turn, ..light(at, shape) });
        }
    }
    scene.bounds = ([-51.0, -2.5, -51.0], [51.0, 30.0, 51.0]);
    scene
}

/// Cells of a metre. A steep rim keeps everything on the mesh, so that a body that leaves has
/// fallen through it.
fn hills() -> Mesh {
    let n = 101usize;
    let rim = |x: f32| 2.0 * (x.abs() - 43.0).max(0.0);
    let hill = |x: f32, z: f32| 1.5 * (0.21 * x).sin() * (0.17 * z).cos();
    let bump = |x: f32, z: f32| 0.25 * (0.9 * x + 0.3).sin() * (0.8 * z).sin();
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..n {
        for j in 0..n {
            let (x, z) = (i as f32 - 50.0, j as f32 - 50.0);
            points.push([x, hill(x, z) + bump(x, z) + rim(x) + rim(z), z]);
            if i + 1 < n && j + 1 < n {
                let a = (i * n + j) as u32;
                let (b, c, d) = (a + 1, a + n as u32, a + n as u32 + 1);
                triangles.extend([[a, b, c], [c, b, d]]);
            }
        }
    }
    Mesh { points, triangles }
}
