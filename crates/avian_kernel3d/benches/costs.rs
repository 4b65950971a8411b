//! Scenes whose instructions are counted. The source is shared by both dimensions.

use avian_kernel3d as kernel;

#[allow(unused, reason = "of the tests, only their helpers are used")]
#[path = "../../../tests/kernel/mod.rs"]
mod shared;

fn main() {
    shared::costs::main();
}
