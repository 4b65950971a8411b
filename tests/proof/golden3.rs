//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0xa884e08e69e984b6),
    ("pyramids", 0x994912915a6ac66d),
    ("tumbler", 0xbab16940d8777b18),
    ("dominoes", 0x6a1c8f613eec2203),
    ("card_house", 0x91dc8f1f4a0b16eb),
    ("towers", 0x18ce96b9cb419cb0),
    ("smash", 0xed0d042c1d3a34be),
    ("crowd", 0xaa0ff4ea2c3e4c39),
    ("sleepers", 0x5e86ea5b051c97ac),
    ("bounces", 0xb086125d8dcfc8a7),
    ("settings", 0xb58856ebf02ffed2),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0xe0837f837078430c), ("slopes", 0xd45da14e864a8ca4)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
