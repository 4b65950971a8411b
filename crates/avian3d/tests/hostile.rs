//! What avian3d makes of input that makes no sense; the file is shared with avian2d.

#[path = "../../../tests/hostile_dim3.rs"]
mod dim;
#[path = "../../../tests/hostile.rs"]
mod hostile;
