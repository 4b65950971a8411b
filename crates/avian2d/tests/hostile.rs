//! What avian2d makes of input that makes no sense; the file is shared with avian3d.

#[path = "../../../tests/hostile_dim2.rs"]
mod dim;
#[path = "../../../tests/hostile.rs"]
mod hostile;
