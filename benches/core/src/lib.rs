//! The part of the benches that is independent of engines: worlds, scenes, clock, measures of the final
//! state, and the worker that runs one scene on one engine.
//!
//! Everything is written once for both dimensions, over the types of a [`world::Dimension`].

pub mod chains;
pub mod dim2;
pub mod dim3;
pub mod engine;
pub mod machine;
pub mod measure;
mod passed;
mod random;
mod ruler;
pub mod scene;
mod scenes2d;
mod scenes3d;
pub mod worker;
pub mod world;
