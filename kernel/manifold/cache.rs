//! What a pair remembers of its last manifold, to start the next one from.

/// The separating axis or reference feature of a pair's last manifold: eight bytes in its contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeatureCache {
    /// Which kind of axis: 0 none, then as the pair's function numbers them.
    pub kind: u8,
    /// A feature of shape A.
    pub a: u8,
    /// A feature of shape B.
    pub b: u8,
    /// The separation along that axis when it was found, in metres.
    pub separation: f32,
}

impl FeatureCache {
    /// Nothing is known.
    pub const NONE: Self = Self { kind: 0, a: 0, b: 0, separation: 0.0 };
}
