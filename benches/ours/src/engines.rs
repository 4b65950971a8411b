//! The adapters, by path: the same files as for upstream.

#[path = "../../cli/src/engines/app.rs"]
pub mod app;
#[path = "../../cli/src/engines/avian2d.rs"]
pub mod avian2d;
#[path = "../../cli/src/engines/avian3d.rs"]
pub mod avian3d;
