//! Small shapes fall into a yard between four walls: all kinds with cylinders among them, and
//! cylinders alone.

use super::{light, rock};
use crate::{
    dim3::{Body3, D3, Shape3, turn_about},
    random::Random,
    scene::{Plan, Scene},
};

const CYLINDER: Shape3 = Shape3::Cylinder(0.4, 0.4);

/// Balls, boxes, capsules, rocks and cylinders, a fifth each.
pub(super) fn mixed() -> Scene<D3> {
    let about = "2,000 balls, boxes, capsules, rocks and cylinders, a fifth each, fall between walls";
    let kinds =
        [Shape3::Sphere(0.4), Shape3::Box(0.4, 0.35, 0.4), Shape3::Capsule(0.25, 0.25), rock(0.5), CYLINDER];
    pile(about, &kinds)
}

/// Cylinders alone.
pub(super) fn cylinders() -> Scene<D3> {
    pile("2,000 cylinders fall between walls", &[CYLINDER])
}

fn pile(about: &str, kinds: &[Shape3]) -> Scene<D3> {
    let mut scene = Scene::new(about, Plan::steps(300));
    scene.bodies.push(Body3::fixed([0.0, -1.0, 0.0], Shape3::Box(20.0, 1.0, 20.0)));
    for side in [-7.0, 7.0] {
        scene.bodies.push(Body3::fixed([side, 15.0, 0.0], Shape3::Box(1.0, 15.0, 8.0)));
        scene.bodies.push(Body3::fixed([0.0, 15.0, side], Shape3::Box(8.0, 15.0, 1.0)));
    }
    let mut random = Random::new(5);
    for i in 0..2000 {
        let (x, z, layer) = (i % 10, i / 10 % 10, i / 100);
        let at = [
            1.1 * (x as f32 - 4.5) + random.range(-0.05, 0.05),
            0.8 + 1.2 * layer as f32,
            1.1 * (z as f32 - 4.5) + random.range(-0.05, 0.05),
        ];
        let axis = [random.range(-1.0, 1.0), 1.1, random.range(-1.0, 1.0)];
        let turn = turn_about(axis, random.range(-2.0, 2.0));
        let kind = &kinds[(x + 2 * z + 3 * layer) % kinds.len()];
        scene.bodies.push(Body3 { turn, ..light(at, kind.clone()) });
    }
    scene.bounds = ([-6.1, -0.5, -6.1], [6.1, 40.0, 6.1]);
    scene
}
