//! Pairs of colliders that are near each other: their records, the narrow phase that keeps manifolds up to
//! date, and [`ContactManager`], which alone changes contacts, colours and islands.
//!
//! `narrow_phase` is read top to bottom; `input`, `recycle`, `manifold_update`, `time_of_impact`,
//! `internal` and `impulse_transfer` are its helpers and do not depend on it. `table` takes the embedder's
//! changes to its results. `crowd` bounds the contacts of bodies in one place.

mod constraint;
mod crowd;
mod impulse_transfer;
mod input;
mod internal;
mod manager;
mod manifold_update;
mod narrow_phase;
mod record;
mod recycle;
mod table;
mod time_of_impact;

pub use input::{ManifoldSource, NarrowPhaseInput};
pub use manager::{ContactManager, Status};
pub use manifold_update::WorkerBuffers;
pub use record::{Contact, ContactFlags, Frozen, Manifold, ManifoldPoint, ManifoldSurface};
pub(crate) use recycle::CHORD;
pub use table::ContactTable;
pub(crate) use table::ManifoldsView;

#[cfg(test)]
mod tests;
