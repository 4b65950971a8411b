//! Containers of ids for both dimensions: a pool that allocates ids, a set of ids, a map from pairs of ids.
//! Also slices that several threads change at once, and the decision when buffers are given back.
//!
//! The containers are plain values: `Clone` is a snapshot, and results depend only on the calls made, never
//! on addresses, hash seeds or threads.

mod bit_set;
mod id_pool;
mod pair_set;
mod parts;
mod prefetch;
mod slack;

pub use bit_set::BitSet;
pub use id_pool::IdPool;
pub use pair_set::PairSet;
pub(crate) use parts::Parts;
pub(crate) use prefetch::prefetch;
pub use slack::Slack;
