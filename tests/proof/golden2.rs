//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x784c5cdeea8452ab),
    ("pyramids", 0x811b86f3099b89ca),
    ("tumbler", 0x67d109aab949b0c8),
    ("dominoes", 0xdf87b39988156767),
    ("card_house", 0x7a3a6bc972a90418),
    ("towers", 0x197dd90759ba2f7a),
    ("smash", 0x013c5d75b84f8602),
    ("crowd", 0x2304f70b12cd1d7a),
    ("sleepers", 0xa68827292e0ff3f7),
    ("bounces", 0x7cd7c66480d8ba38),
    ("settings", 0x78941906698fa169),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x7f19855c2e8a0fcb), ("slopes", 0x292d8b0878a19b65)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
