//! Tables for the documentation. The source is shared by both dimensions.

use avian_kernel2d as kernel;

#[allow(unused, reason = "of the tests, only the surveys are used")]
#[path = "../../../tests/kernel/mod.rs"]
mod shared;

fn main() {
    shared::surveys::main();
}
