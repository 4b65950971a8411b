//! Bodies of two triangles each, in a trough.

use crate::{
    dim2::{Body2, D2, Part2, Shape2},
    scene::{Plan, Scene},
    world::Kind,
};

pub(super) fn scene() -> Scene<D2> {
    let about = "3,000 bodies of two crossed triangles each fall into a trough of 281 boxes";
    let mut scene = Scene::new(about, Plan::settled(1, 499));
    scene.sleeping = true;
    let mut trough: Vec<Part2> =
        (-40..=40).map(|x| Part2::at([x as f32, 0.0], Shape2::Box(0.55, 0.5))).collect();
    for y in 1..=100 {
        trough.extend([-40.0, 40.0].map(|x| Part2::at([x, y as f32], Shape2::Box(0.5, 0.55))));
    }
    scene.bodies.push(Body2::compound(Kind::Static, [0.0, 0.0], trough));
    let left = vec![[-1.0, 0.0], [0.5, 1.0], [0.0, 2.0]];
    let right = vec![[1.0, 0.0], [-0.5, 1.0], [0.0, 2.0]];
    let triangles = [left, right].map(|points| Part2::at([0.0; 2], Shape2::Poly(points)));
    let mut side = -0.25;
    for column in 0..20 {
        for row in 0..150 {
            side = -side;
            let at = [2.0 * column as f32 - 19.0 + side, 2.25 * row as f32 + 5.575];
            let body = Body2::compound(Kind::Dynamic, at, triangles.to_vec());
            scene.bodies.push(Body2 { friction: 0.5, ..body });
        }
    }
    scene.bounds = ([-40.5, -0.5], [40.5, 400.0]);
    scene
}
