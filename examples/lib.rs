//! One idea each: `cargo run -p examples3d --example hello`, or 2d; this file only makes the folder a package.
