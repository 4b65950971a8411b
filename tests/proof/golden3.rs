//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use avian::prelude::*;

/// For each scene of native shapes the hash of its final state.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x006aec9f2adbe3f8),
    ("pyramids", 0x994912915a6ac66d),
    ("tumbler", 0x5406fff1a7cf7603),
    ("dominoes", 0x0abdc0429122614e),
    ("card_house", 0xe6146903538ecac2),
    ("towers", 0x18ce96b9cb419cb0),
    ("smash", 0x2ab45985fba87aef),
    ("crowd", 0x2f5e70b7956fdb8b),
    ("sleepers", 0x6f1e4d124fce0c76),
    ("bounces", 0x6611344f5d4723f9),
    ("settings", 0xf614c9da76575b6d),
];

/// For each scene with shapes of parry the hash of its final state.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x745a0e39b46d3250), ("slopes", 0x74769eadeb619837)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 7;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    velocity.0.to_array().map(f32::to_bits).into()
}
