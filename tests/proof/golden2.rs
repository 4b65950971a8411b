//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x29803d02e0db706e),
    ("pyramids", 0x888870d04d87832e),
    ("tumbler", 0x7468c18ee5fc3dca),
    ("dominoes", 0xb4414cdc554b6304),
    ("card_house", 0x89af10a9989e0fba),
    ("towers", 0x41e006eb86452b02),
    ("smash", 0x947b65a3059fba93),
    ("crowd", 0xed73d6b8ccab7b5c),
    ("sleepers", 0x4e0efe5706ee98bf),
    ("bounces", 0xf019a32d553cc2ea),
    ("settings", 0x89044fc8acda76e9),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0xa4ad974dd28dd64d), ("slopes", 0x8845ec133ae003a8)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
