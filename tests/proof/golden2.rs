//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0xbba2c4cd210c8aec),
    ("pyramids", 0x151cac7bb3d1d58e),
    ("tumbler", 0x705b1895a9b8b9cd),
    ("dominoes", 0x303c81709b176fad),
    ("card_house", 0x031ab5f9d97793af),
    ("towers", 0x197dd90759ba2f7a),
    ("smash", 0x0da31b018b647363),
    ("crowd", 0xf163115afb379214),
    ("sleepers", 0xc1dd933a3185971e),
    ("bounces", 0x8976a6ac8709aeb9),
    ("settings", 0x73b3c91f5f96f5f8),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x92fbb60b17efcd80), ("slopes", 0xb75bfa46884708ea)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
