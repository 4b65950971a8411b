//! Worlds in which little or nothing moves, and levels that come and go.

use super::light;
use crate::{
    dim3::{Body3, D3, Shape3},
    scene::{Plan, Scene, Work},
};

pub(super) fn empty() -> Scene<D3> {
    Scene::new("nothing at all", Plan::settled(60, 500))
}

pub(super) fn sleeping() -> Scene<D3> {
    let about = "20,000 static boxes as a floor and 1,000 asleep on it";
    let mut scene = Scene::new(about, Plan::settled(180, 200));
    scene.sleeping = true;
    add_static(&mut scene, 200, 100);
    add_resting(&mut scene);
    scene
}

pub(super) fn fixed() -> Scene<D3> {
    let mut scene = Scene::new("100,000 static boxes as a floor", Plan::settled(60, 200));
    add_static(&mut scene, 1000, 100);
    scene
}

pub(super) fn awake() -> Scene<D3> {
    let about = "100,000 static boxes as a floor and 1,000 at rest on it that may not sleep";
    let mut scene = Scene::new(about, Plan::settled(60, 200));
    add_static(&mut scene, 1000, 100);
    add_resting(&mut scene);
    scene
}

/// Some boxes at rest on one, kept awake.
pub(super) fn few(count: usize) -> Scene<D3> {
    let about = format!("{count} at rest on a large one, kept awake");
    let mut scene = Scene::new(about, Plan::settled(60, 1000));
    scene.bodies.push(Body3::fixed([0.0, -0.5, 0.0], Shape3::Box(100.0, 0.5, 100.0)));
    for i in 0..count {
        let at = [2.0 * (i % 10) as f32, 0.4, 2.0 * (i / 10) as f32];
        scene.bodies.push(light(at, Shape3::Box(0.4, 0.4, 0.4)));
    }
    scene
}

/// A level comes or goes.
pub(super) fn bulk(work: Work) -> Scene<D3> {
    let about = match work {
        Work::Spawn => "200,000 static boxes are added, up to the step that takes them in",
        _ => "200,000 static boxes are removed, up to the step that lets them go",
    };
    let mut scene = Scene::new(about, Plan { settle: 0, ..Plan::batches(work, 3) });
    add_static(&mut scene, 1000, 200);
    scene
}

/// A floor of boxes, side by side.
fn add_static(scene: &mut Scene<D3>, columns: usize, rows: usize) {
    for column in 0..columns {
        for row in 0..rows {
            let at = [column as f32, 0.0, row as f32];
            scene.bodies.push(Body3::fixed(at, Shape3::Box(0.5, 0.5, 0.5)));
        }
    }
}

/// A thousand boxes on the first 200 by 100 of the floor.
fn add_resting(scene: &mut Scene<D3>) {
    for column in 0..50 {
        for row in 0..20 {
            let at = [4.0 * column as f32 + 2.0, 0.9, 5.0 * row as f32 + 2.0];
            scene.bodies.push(light(at, Shape3::Box(0.4, 0.4, 0.4)));
        }
    }
}
