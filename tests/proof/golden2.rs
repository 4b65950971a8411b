//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x6c2e4a04e7dbe439),
    ("pyramids", 0x888870d04d87832e),
    ("tumbler", 0xb67db5a988ba8dbd),
    ("dominoes", 0x7d8a9b7741a2e923),
    ("card_house", 0x452e86ea9cf7f716),
    ("towers", 0x41e006eb86452b02),
    ("smash", 0x9374de5208f92c8b),
    ("crowd", 0x97af27847daa3ae7),
    ("sleepers", 0x9fe5f4247476bce3),
    ("bounces", 0x1211ff4950806e37),
    ("settings", 0xa4f3b7838968b85d),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0xe7cf932b4f32d0f4), ("slopes", 0x71b94385298d2184)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
