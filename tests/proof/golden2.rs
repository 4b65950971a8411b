//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x13c61d2ecb490375),
    ("pyramids", 0x811b86f3099b89ca),
    ("tumbler", 0x8b7f4b9bf261f285),
    ("dominoes", 0x8d1ac626476d604d),
    ("card_house", 0x7a3a6bc972a90418),
    ("towers", 0x197dd90759ba2f7a),
    ("smash", 0xd6c5394bfe6156f1),
    ("crowd", 0x4f876bd62e22b5fb),
    ("sleepers", 0xb19b13f15278256b),
    ("bounces", 0x097b1c0098787cd5),
    ("settings", 0x99290ea5fbe2de99),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x2548410c3fe71a61), ("slopes", 0x292d8b0878a19b65)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
