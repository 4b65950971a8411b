//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x43df1d3a5c62e4d0),
    ("pyramids", 0x3b8247051981a619),
    ("tumbler", 0xc0e8f8fd02fe0eea),
    ("dominoes", 0x72f192a6b32b4885),
    ("card_house", 0x532fcd4dd3c91c9e),
    ("towers", 0xbbc1401e3eb53693),
    ("smash", 0x9fec122e2ce5f14c),
    ("crowd", 0xd629cd600cf7ef85),
    ("sleepers", 0x081bfa3931a0d1cf),
    ("bounces", 0x3b38787d0e83c4e2),
    ("settings", 0x575416dd75e7f1fb),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x75feae19c23968fc), ("slopes", 0xcfa06a41354c3b72)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
