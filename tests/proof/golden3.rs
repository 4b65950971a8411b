//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x6adbd9dda75add28),
    ("pyramids", 0x17a8afd77f7dc398),
    ("tumbler", 0xb27cd220abc76013),
    ("dominoes", 0xac7b849ae9d2ce46),
    ("card_house", 0x15a5ba7543678eac),
    ("towers", 0x4a66ad8c890eac3c),
    ("smash", 0xfd9230a6d29175a2),
    ("crowd", 0xb702be00d3d94b35),
    ("sleepers", 0xf9dc327a40fcb339),
    ("bounces", 0xccb55e1a4906b501),
    ("settings", 0x9bc46dfe96d8fb35),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x1c15b283cb894985), ("slopes", 0x0a866a3562ced4f0)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
