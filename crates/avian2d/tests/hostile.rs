//! What avian2d makes of input that makes no sense; the file is shared with avian3d.

#[path = "../../../tests/hostile.rs"]
mod hostile;
