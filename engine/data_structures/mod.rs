//! Data structures of the public interface.

pub mod pair_key;
