//! Custom constraints: objects of the embedder that change the velocities of two bodies. They are in
//! colours and islands like all others.

mod batch;
mod body;
mod table;

pub(super) use batch::{CUSTOM_BATCHES, CustomRows, CustomView, customs, sort_customs};
pub use body::CustomBody;
pub(super) use table::Records;
pub use table::{CustomConstraint, CustomError, CustomTable};
