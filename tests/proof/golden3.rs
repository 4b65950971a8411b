//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x8a04fbd2f6e00a67),
    ("pyramids", 0x7029bf7b80ae7227),
    ("tumbler", 0x218bd6ef846392ab),
    ("dominoes", 0x14a231b7f3e1e3a3),
    ("card_house", 0x1a67c49ad49777b0),
    ("towers", 0x731bb49d21a6ade1),
    ("smash", 0xe6aeeb72a4c876b4),
    ("crowd", 0xf5826c7d0834f572),
    ("sleepers", 0x9c530a3ca9e34cba),
    ("bounces", 0x5e3416363a4a45f1),
    ("settings", 0xabb866586f42ffff),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0xd80537976dacab5b), ("slopes", 0xf6330e00c2a1ebe6)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
