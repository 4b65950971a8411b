//! Golden hashes in space, and what their scenes must know of it. `golden2.rs` is the twin.

use avian::prelude::*;

/// Of each scene of native shapes the hash that it ends with.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0xd9cea250dfd32ffd),
    ("pyramids", 0x7029bf7b80ae7227),
    ("tumbler", 0x6005dbfa129e5b1d),
    ("dominoes", 0x40308d6d064a7cf0),
    ("card_house", 0x90d749d490421cda),
    ("towers", 0xd2a8b3dee5310c3d),
    ("smash", 0x32a2ad9a5a3523f1),
    ("crowd", 0xb426d1d6efcb702d),
    ("sleepers", 0x871d60db30bc3664),
    ("bounces", 0x5616e359153bb436),
    ("settings", 0x3b1fd4246782c1e4),
];

/// The same for scenes with shapes of parry's.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0xbf6cd3b56dfe9545), ("slopes", 0xba42dad610ed3d14)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
