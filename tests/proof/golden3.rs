//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0xd9cea250dfd32ffd),
    ("pyramids", 0x7029bf7b80ae7227),
    ("tumbler", 0xd886e890208fbe92),
    ("dominoes", 0xff468b865f6a968e),
    ("card_house", 0xf6ee1a29a9454c89),
    ("towers", 0x731bb49d21a6ade1),
    ("smash", 0x1233a251bc463aa9),
    ("crowd", 0xb426d1d6efcb702d),
    ("sleepers", 0x3af54b51ee6e874f),
    ("bounces", 0x18da6393fc8a039a),
    ("settings", 0x836c0d1792f635ab),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x7edbf9fc8f657745), ("slopes", 0x68fde958728f18fb)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
