//! Golden hashes in space, and what their scenes must know of it. `golden2.rs` is the twin.

use avian::prelude::*;

/// Of each scene of native shapes the hash that it ends with.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0xd9cea250dfd32ffd),
    ("pyramids", 0x7029bf7b80ae7227),
    ("tumbler", 0x707d6493c37f26e9),
    ("dominoes", 0xfc7d9b2f1da5e5b4),
    ("card_house", 0x9493cc329b9e35b2),
    ("towers", 0x731bb49d21a6ade1),
    ("smash", 0x295fe2b091d792cd),
    ("crowd", 0xb426d1d6efcb702d),
    ("sleepers", 0x420de4f6f14d4a56),
    ("bounces", 0x18da6393fc8a039a),
    ("settings", 0x52473f9774201a3d),
];

/// The same for scenes with shapes of parry's.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x9d28443301e18bfc), ("slopes", 0x063d153ea24b9ba8)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
