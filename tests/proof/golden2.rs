//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x1b363c79a7d1c942),
    ("pyramids", 0x811b86f3099b89ca),
    ("tumbler", 0x0ea202665cdba5a9),
    ("dominoes", 0x6f2cd167c25f9c7c),
    ("card_house", 0x7a3a6bc972a90418),
    ("towers", 0x197dd90759ba2f7a),
    ("smash", 0x70a2498063d96962),
    ("crowd", 0x4f876bd62e22b5fb),
    ("sleepers", 0xcc1e733e376113e0),
    ("bounces", 0xad1d6998ab706d42),
    ("settings", 0xcb0ba3ffe1dce8be),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0xa6785f201dd63b37), ("slopes", 0x292d8b0878a19b65)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
