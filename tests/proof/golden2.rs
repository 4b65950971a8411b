//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x1390e97974966d13),
    ("pyramids", 0x811b86f3099b89ca),
    ("tumbler", 0x0ea202665cdba5a9),
    ("dominoes", 0x6f2cd167c25f9c7c),
    ("card_house", 0x7a3a6bc972a90418),
    ("towers", 0x197dd90759ba2f7a),
    ("smash", 0x6f189f29815f188d),
    ("crowd", 0x4f876bd62e22b5fb),
    ("sleepers", 0x3e68cc78f2137c5d),
    ("bounces", 0x40183008e5387241),
    ("settings", 0xd563391653547760),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0xa6785f201dd63b37), ("slopes", 0x292d8b0878a19b65)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
