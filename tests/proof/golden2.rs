//! Golden hashes in the plane, and what their scenes must know of it. `golden3.rs` is the twin.

use avian::prelude::*;

/// Of each scene of native shapes the hash that it ends with.
pub const NATIVE: [(&str, u64); 11] = [
    ("pyramid", 0x6c2e4a04e7dbe439),
    ("pyramids", 0x888870d04d87832e),
    ("tumbler", 0x8af45b7ebc464ee4),
    ("dominoes", 0x32d104eef11a046e),
    ("card_house", 0xfb05f5bf417f986f),
    ("towers", 0xf7210e556bbf3a1d),
    ("smash", 0x53f31d5ad93edf28),
    ("crowd", 0x97af27847daa3ae7),
    ("sleepers", 0x4ddf5e53115f50aa),
    ("bounces", 0x7e1c153dd018d486),
    ("settings", 0x6a4dfed1c4bc129d),
];

/// The same for scenes with shapes of parry's.
pub const FOREIGN: [(&str, u64); 2] = [("pile", 0x9efb3b8a13758898), ("slopes", 0xeffe19ef4eff022f)];

/// Boxes along a side of the tumbler.
pub const TUMBLER_SIDE: u32 = 20;

/// The bits of an angular velocity.
pub fn spin_bits(velocity: AngularVelocity) -> Vec<u32> {
    vec![velocity.0.to_bits()]
}
