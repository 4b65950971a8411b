//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x8a04fbd2f6e00a67),
    ("pyramids", 0x7029bf7b80ae7227),
    ("tumbler", 0x76f7e7aa96c6fc3a),
    ("dominoes", 0x14a231b7f3e1e3a3),
    ("card_house", 0x1e147483c0a9d043),
    ("towers", 0x18ce96b9cb419cb0),
    ("smash", 0x27ab40a32ed57e26),
    ("crowd", 0xae6f27b589dd1b40),
    ("sleepers", 0x9c530a3ca9e34cba),
    ("bounces", 0x31195b3496705b03),
    ("settings", 0x18a68a91a67dbad7),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x27cd3f951e5aa439), ("slopes", 0xf6330e00c2a1ebe6)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
