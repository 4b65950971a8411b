//! Golden hashes in the plane, and what their scenes must know of it. `golden3.rs` is the twin.

use avian::prelude::*;

/// Of each scene of native shapes the hash that it ends with.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x77f755d34138ed9f),
    ("pyramids", 0x888870d04d87832e),
    ("tumbler", 0x1f0734448ffe3412),
    ("dominoes", 0xb9b96728fd49e1d3),
    ("card_house", 0xfb05f5bf417f986f),
    ("towers", 0xf7210e556bbf3a1d),
    ("smash", 0x67267eb7d2bddd9a),
    ("crowd", 0xb07ca5a22c483c44),
    ("sleepers", 0x51524439f31da516),
    ("bounces", 0x8e39d676fce64acc),
    ("settings", 0xa8303dbf3b509cbe),
];

/// The same for scenes with shapes of parry's.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0xe3e69cfa755d09f4), ("slopes", 0xeffe19ef4eff022f)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
