//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0xd9f6715fae8cf943),
    ("pyramids", 0x7029bf7b80ae7227),
    ("tumbler", 0x0594023391ce818e),
    ("dominoes", 0xb85f111af1758779),
    ("card_house", 0xf6ee1a29a9454c89),
    ("towers", 0x731bb49d21a6ade1),
    ("smash", 0x2bb1a590106897a3),
    ("crowd", 0x9bf2e8517eadf9e0),
    ("sleepers", 0x57b927eec5c77dd1),
    ("bounces", 0xf405a34244bc2ff7),
    ("settings", 0x94c20ab8cba0493f),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0xd36d322fb40c9c4b), ("slopes", 0x68fde958728f18fb)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
