//! Tests of the kernel's parts together, without Bevy. The source is shared by both dimensions.

use avian_kernel2d as kernel;

#[path = "../../../tests/kernel/mod.rs"]
mod shared;
