//! An empty package for `tests/rules.rs`.
