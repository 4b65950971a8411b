//! Renders examples and looks at the pixels. `AVIAN_PICTURES=docs/pictures cargo test --release -p examples3d` writes the
//! pictures of the docs.

#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/ccd.rs"]
mod ccd;
#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/debug_drawing.rs"]
mod debug_drawing;
#[path = "../../pictures.rs"]
mod pictures;

use avian3d::prelude::*;
use bevy::prelude::*;
use pictures::{Studio, count, keep};

#[test]
fn outlines_are_seen_and_can_be_turned_off() {
    let Some(mut studio) = Studio::new(debug_drawing::plugin) else { return };
    studio.frames(64);
    let drawn = studio.capture();
    keep(&drawn, "debug_drawing_3d.png");
    let mut store = studio.app.world_mut().resource_mut::<GizmoConfigStore>();
    store.config_mut::<PhysicsGizmos>().0.enabled = false;
    let bare = studio.capture();
    // Outlines of bodies that are awake.
    let orange = |image: &Image| count(image, |[r, g, b]| r > 180 && (60..190).contains(&g) && b < 110);
    // 17 bodies with outlines of hundreds of pixels each, most of them orange.
    assert!(orange(&drawn) > 2000 && orange(&bare) < 100, "{} {}", orange(&drawn), orange(&bare));
}

#[test]
fn bullets_of_the_first_mode_pass_the_plate_and_no_other() {
    let Some(mut studio) = Studio::new(ccd::plugin) else { return };
    studio.frames(256);
    keep(&studio.capture(), "ccd_3d.png");
    let mut cubes = studio
        .app
        .world_mut()
        .query_filtered::<(&Position, Has<SpeculativeMargin>, Has<SweptCcd>), With<ccd::Bullet>>();
    let mut passed = [0; 3];
    for (at, no_prediction, is_swept) in cubes.iter(studio.app.world()) {
        assert!(at.z > -5.0, "one is behind the wall: {at:?}");
        passed[usize::from(no_prediction) + usize::from(is_swept)] += usize::from(at.z < -0.1);
    }
    // Prediction, neither, sweep.
    assert!(passed[1] > 0 && passed[0] + passed[2] == 0, "behind the plates: {passed:?}");
}
