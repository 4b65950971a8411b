//! Custom constraints: objects of the embedder that change the velocities of two bodies. They are in
//! colours and islands like all others.

mod body;
mod custom_batch;
mod table;

pub use body::CustomBody;
pub(super) use custom_batch::{CUSTOM_BATCHES, CustomRows, CustomView, customs, sort_customs};
pub(super) use table::Records;
pub use table::{CustomConstraint, CustomError, CustomTable};
