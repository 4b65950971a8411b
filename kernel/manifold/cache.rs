//! The feature cache of a pair: what its next manifold starts from.

/// The separating axis or reference feature of a pair's last manifold: eight bytes in its contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeatureCache {
    /// The kind of axis: 0 is none, the others are numbered by the function of the pair.
    pub kind: u8,
    /// A feature of shape A.
    pub a: u8,
    /// A feature of shape B.
    pub b: u8,
    /// The separation along that axis when it was found, in metres.
    pub separation: f32,
}

impl FeatureCache {
    /// An empty cache.
    pub const NONE: Self = Self { kind: 0, a: 0, b: 0, separation: 0.0 };
}
