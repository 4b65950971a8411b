//! How long shapes take to make. The source is shared by both dimensions.

use avian_kernel2d as kernel;

#[path = "../../../tests/measure/making.rs"]
mod shared;

fn main() {
    shared::main();
}
