//! The 3D engine under the name that shared docs and tests import: `avian`.

pub use avian3d::*;
