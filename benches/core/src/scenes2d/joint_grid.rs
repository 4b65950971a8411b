//! A curtain of joints.

use crate::{
    dim2::{Body2, D2, Joint2, Shape2},
    scene::{Plan, Scene},
    world::{Group, Kind},
};

pub(super) fn scene() -> Scene<D2> {
    let about = "100 x 100 circles that do not collide, held by revolute joints, hung from seven";
    let mut scene = Scene::new(about, Plan::steps(200));
    let n = 100usize;
    for k in 0..n {
        for i in 0..n {
            let held = i == 0 && k + 3 >= n / 2 && k <= n / 2 + 3;
            let kind = if held { Kind::Static } else { Kind::Dynamic };
            let body = Body2::new(kind, [k as f32, -(i as f32)], Shape2::Circle(0.4));
            let me = scene.bodies.len();
            scene.bodies.push(Body2 { group: Group::NotEachOther, ..body });
            if i > 0 {
                let anchors = [[0.0, -0.5], [0.0, 0.5]];
                scene.joints.push(Joint2::free([me - 1, me], anchors));
            }
            // Two static neighbours need no joint between them, and some engines refuse one.
            if k > 0 && !(held && scene.bodies[me - n].kind == Kind::Static) {
                let anchors = [[0.5, 0.0], [-0.5, 0.0]];
                scene.joints.push(Joint2::free([me - n, me], anchors));
            }
        }
    }
    scene.bounds = ([-500.0, -500.0], [600.0, 500.0]);
    scene
}
