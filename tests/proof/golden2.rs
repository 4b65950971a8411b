//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x29803d02e0db706e),
    ("pyramids", 0x888870d04d87832e),
    ("tumbler", 0x7468c18ee5fc3dca),
    ("dominoes", 0xb4414cdc554b6304),
    ("card_house", 0x1f8c1eb16ec88d60),
    ("towers", 0x197dd90759ba2f7a),
    ("smash", 0xf2b5e69b7986c1f0),
    ("crowd", 0xec938ddc1966a4f1),
    ("sleepers", 0x4e0efe5706ee98bf),
    ("bounces", 0xaa2e0f025da4da6b),
    ("settings", 0x89044fc8acda76e9),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0xe0b0a8250455a34e), ("slopes", 0x8845ec133ae003a8)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
