//! Golden hashes in space, and what their scenes must know of it. `golden2.rs` is the twin.

use avian::prelude::*;

/// Of each scene of native shapes the hash that it ends with.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0xd9cea250dfd32ffd),
    ("pyramids", 0x7029bf7b80ae7227),
    ("tumbler", 0x02dd7fedf5e8dc41),
    ("dominoes", 0xba98b1514ca40767),
    ("card_house", 0x05215463f94ddd84),
    ("towers", 0xd2a8b3dee5310c3d),
    ("smash", 0xeb79e34522b51092),
    ("crowd", 0xb426d1d6efcb702d),
    ("sleepers", 0xb6981b0d88511f7b),
    ("bounces", 0x8f9a488b049f9e5c),
    ("settings", 0x955f0faddafa4e3b),
];

/// The same for scenes with shapes of parry's.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x88955afb94e3a15e), ("slopes", 0x8c9311e841c281a9)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
