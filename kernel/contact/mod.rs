//! Pairs of colliders that are near each other: their records, the manifold update with recycling, and
//! the one door through which contacts, colours and islands change.

mod link;
mod phase;
mod record;
mod recycle;
mod shared;
mod sweep;
mod table;
mod update;

pub use link::{Link, Status};
pub use phase::{ManifoldSource, NarrowPhase};
pub use record::{Contact, ContactFlags, Frozen, Manifold, ManifoldPoint};
pub(crate) use shared::ManifoldsView;
pub use table::ContactTable;
pub use update::{Found, Scratch};

#[cfg(test)]
mod tests;
