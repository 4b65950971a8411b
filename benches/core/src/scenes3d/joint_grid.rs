//! A curtain of joints.

use super::light;
use crate::{
    dim3::{Body3, D3, Joint3, Shape3},
    scene::{Plan, Scene},
    world::{Group, Kind},
};

pub(super) fn scene() -> Scene<D3> {
    let about = "100 x 100 spheres that do not collide, held by spherical joints, top row fixed";
    let mut scene = Scene::new(about, Plan::steps(150));
    let n = 100usize;
    for k in 0..n {
        for i in 0..n {
            let kind = if i == 0 { Kind::Static } else { Kind::Dynamic };
            let body = light([k as f32, -(i as f32), 0.0], Shape3::Sphere(0.4));
            let me = scene.bodies.len();
            scene.bodies.push(Body3 { kind, group: Group::NotEachOther, ..body });
            if i > 0 {
                let anchors = [[0.0, -0.5, 0.0], [0.0, 0.5, 0.0]];
                scene.joints.push(Joint3::free([me - 1, me], anchors));
            }
            if k > 0 && i > 0 {
                let anchors = [[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0]];
                scene.joints.push(Joint3::free([me - n, me], anchors));
            }
        }
    }
    scene.bounds = ([-200.0; 3], [300.0; 3]);
    scene
}
