//! What comes and goes in avian2d; the file is shared with avian3d.

#[path = "../../../tests/lifecycle.rs"]
mod lifecycle;
