//! Nothing but a place for `tests/rules.rs`.
