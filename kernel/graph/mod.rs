//! The constraint graph: colours for parallel solving, and islands for sleeping.
//!
//! Bodies, contacts and links are `u32` ids of the caller. Positions and shapes are unknown here. Both
//! structures persist and are updated when a contact begins or stops touching. They are never rebuilt.

mod colors;
mod islands;
mod kind;
mod sleep;
mod union_find;

pub use colors::{COLOR_COUNT, ColorGraph, ColorSlot, OVERFLOW};
#[cfg(test)]
pub(crate) use islands::VISITS;
pub use islands::{IslandId, IslandLink, Islands, LinkId};
pub use kind::{ConstraintId, ConstraintKind};
pub use sleep::SleepScan;
pub(crate) use union_find::DisjointSets;
