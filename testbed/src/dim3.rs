//! 3D: `avian3d`, its scenes, its shapes.

use avian3d as avian;
use scenes3d as scenes;

#[path = "idle.rs"]
pub mod idle;
#[path = "overlap.rs"]
mod overlap;
#[path = "space3.rs"]
mod space;
#[path = "world.rs"]
mod world;

pub use world::entries;
