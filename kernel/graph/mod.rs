//! What touches or holds what: colouring for parallel solving, and islands for sleeping. Indices only.
//!
//! Bodies, contacts and links are `u32` ids of the caller; nothing here knows a position or a shape.
//! Both structures persist and are updated when a contact begins or stops touching, never rebuilt.

mod colors;
mod islands;
mod kind;
mod sleep;
mod union_find;

pub use colors::{COLOR_COUNT, ColorGraph, ColorSlot, OVERFLOW};
#[cfg(test)]
pub(crate) use islands::VISITS;
pub use islands::{IslandId, Islands, Link, LinkId};
pub use kind::{ConstraintId, ConstraintKind};
pub use sleep::SleepScan;
