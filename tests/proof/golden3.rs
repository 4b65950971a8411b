//! Golden hashes in space, and what their scenes must know of it. `golden2.rs` is the twin.

use avian::prelude::*;

/// Of each scene of native shapes the hash that it ends with.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0xd9cea250dfd32ffd),
    ("pyramids", 0x7029bf7b80ae7227),
    ("tumbler", 0x05f69ece7d8db6b4),
    ("dominoes", 0xb83ca68772f7c210),
    ("card_house", 0x05215463f94ddd84),
    ("towers", 0xd2a8b3dee5310c3d),
    ("smash", 0xebf355a0aa5d5db6),
    ("crowd", 0x87007a3c2ff9cd39),
    ("sleepers", 0xe00ec19ef99b27ea),
    ("bounces", 0x8277111ee5ef3469),
    ("settings", 0xfbc9110ebdf77a3b),
];

/// The same for scenes with shapes of parry's.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x348d85234759c178), ("slopes", 0x8c9311e841c281a9)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
