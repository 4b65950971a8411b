//! The 2D engine under the name that shared docs and tests import: `avian`.

pub use avian2d::*;
