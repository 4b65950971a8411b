//! Renders examples and looks at the pixels. `AVIAN_PICTURES=docs/pictures cargo test --release -p examples2d` writes the
//! pictures of the docs.

#[expect(dead_code, reason = "main is not called")]
#[path = "../examples/ccd.rs"]
mod ccd;
#[path = "../../pictures.rs"]
mod pictures;

use pictures::{Studio, count, keep};

#[test]
fn balls_and_bars_are_seen() {
    let Some(mut studio) = Studio::new(ccd::plugin) else { return };
    studio.frames(128);
    let drawn = studio.capture();
    keep(&drawn, "ccd_2d.png");
    let balls = count(&drawn, |[r, g, b]| r > 180 && (100..200).contains(&g) && b < 110);
    let bars = count(&drawn, |[r, g, b]| r > 110 && r < 190 && g > r && b > g);
    assert!(balls > 100 && bars > 500, "{balls} {bars}");
}
