//! What the narrow phase allocates, in a process of its own. The source is shared by both dimensions.

use avian_kernel2d as kernel;

#[path = "../../../tests/kernel_allocations.rs"]
mod allocations;
