//! Pairs of colliders that are near each other: their records, the narrow phase that keeps manifolds up to date, and
//! [`Link`], which alone changes contacts, colours and islands.
//!
//! `narrow_phase` is read top to bottom; `input`, `recycle`, `manifolds`, `sweep`, `calm`, `internal` and `load` are its
//! helpers and do not know it. `modify` takes what the embedder makes of its results.

mod buffers;
mod calm;
mod constraint;
mod input;
mod internal;
mod link;
mod load;
mod manifolds;
mod modify;
mod narrow_phase;
mod record;
mod recycle;
mod sweep;
mod table;

pub use buffers::WorkerBuffers;
pub use input::{ManifoldSource, NarrowPhaseInput};
pub use link::{Link, Status};
pub use record::{Contact, ContactFlags, Frozen, Manifold, ManifoldPoint, ManifoldSurface};
pub(crate) use recycle::CHORD;
pub use table::ContactTable;
pub(crate) use table::ManifoldsView;

#[cfg(test)]
mod tests;
