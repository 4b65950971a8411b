//! Worlds in which little or nothing moves, and levels that come and go.

use crate::{
    dim2::{Body2, D2, Shape2},
    scene::{Plan, Scene, Work},
};

pub(super) fn empty() -> Scene<D2> {
    Scene::new("nothing at all", Plan::settled(60, 500))
}

/// Boxes at rest on every 20th of 20,000.
pub(super) fn sleeping() -> Scene<D2> {
    let about = "20,000 static boxes and 1,000 asleep on them";
    let mut scene = Scene::new(about, Plan::settled(180, 200));
    scene.sleeping = true;
    add_static(&mut scene, 20);
    add_resting(&mut scene, 20);
    scene
}

pub(super) fn fixed() -> Scene<D2> {
    let mut scene = Scene::new("100,000 static boxes", Plan::settled(60, 200));
    add_static(&mut scene, 100);
    scene
}

pub(super) fn awake() -> Scene<D2> {
    let about = "100,000 static boxes and 1,000 at rest on them that may not sleep";
    let mut scene = Scene::new(about, Plan::settled(60, 200));
    add_static(&mut scene, 100);
    add_resting(&mut scene, 20);
    scene
}

/// Some boxes at rest on one, kept awake.
pub(super) fn few(count: usize) -> Scene<D2> {
    let about = format!("{count} at rest on a large one, kept awake");
    let mut scene = Scene::new(about, Plan::settled(60, 1000));
    scene.bodies.push(Body2::fixed([0.0, -0.5], Shape2::Box(200.0, 0.5)));
    for i in 0..count {
        scene.bodies.push(Body2::dynamic([2.0 * i as f32 - 100.0, 0.4], Shape2::Box(0.4, 0.4)));
    }
    scene
}

/// A level comes or goes.
pub(super) fn bulk(work: Work) -> Scene<D2> {
    let about = match work {
        Work::Spawn => "200,000 static boxes are added, up to the step that takes them in",
        _ => "200,000 static boxes are removed, up to the step that lets them go",
    };
    let mut scene = Scene::new(about, Plan { settle: 0, ..Plan::batches(work, 3) });
    add_static(&mut scene, 200);
    scene
}

/// Rows of 1,000 boxes, side by side.
fn add_static(scene: &mut Scene<D2>, rows: usize) {
    for row in 0..rows {
        for column in 0..1000 {
            let at = [column as f32, row as f32 * 5.0];
            scene.bodies.push(Body2::fixed(at, Shape2::Box(0.5, 0.5)));
        }
    }
}

/// Fifty boxes on each of the first rows.
fn add_resting(scene: &mut Scene<D2>, rows: usize) {
    for row in 0..rows {
        for column in 0..50 {
            let at = [20.0 * column as f32 + 10.0, row as f32 * 5.0 + 0.9];
            scene.bodies.push(Body2::dynamic(at, Shape2::Box(0.4, 0.4)));
        }
    }
}
