//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x0edbdab7b5d3d507),
    ("pyramids", 0x888870d04d87832e),
    ("tumbler", 0x1c5563cc6f749a68),
    ("dominoes", 0xc3220828a5393d70),
    ("card_house", 0x452e86ea9cf7f716),
    ("towers", 0x41e006eb86452b02),
    ("smash", 0x2ce483ff528e1bc9),
    ("crowd", 0x0d73e44ac64833bc),
    ("sleepers", 0xa5167dcbe430320a),
    ("bounces", 0x84305c074520ef12),
    ("settings", 0x72da2333abbf7cfb),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x5a574b7f7e47fdcd), ("slopes", 0x71b94385298d2184)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
