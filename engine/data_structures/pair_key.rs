//! [`PairKey`]: an unordered pair of indices.

use bevy_derive::{Deref, DerefMut};

/// Two indices as one number, which does not depend on their order.
#[derive(Clone, Copy, Debug, Deref, DerefMut, PartialEq, Eq, Hash)]
pub struct PairKey(pub u64);

impl PairKey {
    /// The key of two indices.
    pub const fn new(id1: u32, id2: u32) -> Self {
        let (low, high) = if id1 < id2 { (id1, id2) } else { (id2, id1) };
        Self((low as u64) << 32 | high as u64)
    }

    /// Both indices, the lower first.
    pub fn get(&self) -> (u32, u32) {
        ((self.0 >> 32) as u32, self.0 as u32)
    }
}
