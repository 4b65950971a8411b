//! Golden hashes in space, and what their scenes must know of it. `golden2.rs` is the twin.

use avian::prelude::*;

/// Of each scene of native shapes the hash that it ends with.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x1690578e6679ed21),
    ("pyramids", 0x0308e90136eb2904),
    ("tumbler", 0x1e4fcdef2fc1c721),
    ("dominoes", 0x81e182117e2e54b9),
    ("card_house", 0x4ed56490f1ae7c28),
    ("towers", 0xd34b20b9f11ee56f),
    ("smash", 0x9c1a897af3456266),
    ("crowd", 0x100ad26d4e8d9e18),
    ("sleepers", 0x0f62b41d5088fcbf),
    ("bounces", 0x586355a16a8f4039),
    ("settings", 0x26a882b1d3b00d22),
];

/// The same for scenes with shapes of parry's.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x4e14e12e5ef199d1), ("slopes", 0x6dad82f8394ed14c)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
