//! What comes and goes in avian3d; the file is shared with avian2d.

#[path = "../../../tests/lifecycle.rs"]
mod lifecycle;
