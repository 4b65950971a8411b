//! How long trees take. The source is shared by both dimensions.

use avian_kernel3d as kernel;

#[path = "../../../tests/measure/trees.rs"]
mod shared;

fn main() {
    shared::main();
}
