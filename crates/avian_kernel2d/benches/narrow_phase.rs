//! How long the narrow phase takes. The source is shared by both dimensions.

use avian_kernel2d as kernel;

#[path = "../../../tests/measure/narrow_phase.rs"]
mod shared;

fn main() {
    shared::main();
}
