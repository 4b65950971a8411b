//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0xad6fd9cc4a6856e0),
    ("pyramids", 0xaccd99b8852417a6),
    ("tumbler", 0x6642b438276a4807),
    ("dominoes", 0x0425c6fa55bf4ca6),
    ("card_house", 0xf4350c1cdf4b5132),
    ("towers", 0x44b616d850022b49),
    ("smash", 0x46c219e2ea1b022c),
    ("crowd", 0xb9450924ceec97bf),
    ("sleepers", 0xa5173c407dda63eb),
    ("bounces", 0xb55dfc91c80d7964),
    ("settings", 0xad4d7de2bc82c7bf),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x8701f4c2523e3303), ("slopes", 0xd65f7b51d3ffe456)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
