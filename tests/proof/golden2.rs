//! Golden hashes in the plane, and what their scenes must know of it. `golden3.rs` is the twin.

use avian::prelude::*;

/// Of each scene of native shapes the hash that it ends with.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0xe9e9855b595d9cc4),
    ("pyramids", 0x888870d04d87832e),
    ("tumbler", 0x772cb373ba689292),
    ("dominoes", 0x3c0562cea31b758d),
    ("card_house", 0x1079265245c25a82),
    ("towers", 0xf7210e556bbf3a1d),
    ("smash", 0x8583c5ba25034635),
    ("crowd", 0xb07ca5a22c483c44),
    ("sleepers", 0x1b0c8b597e1a713f),
    ("bounces", 0x799536c44e9fa594),
    ("settings", 0x9f2cd5039e45c69c),
];

/// The same for scenes with shapes of parry's.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x7afaddf18ee1b6a6), ("slopes", 0x0623ca1d48c39188)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
