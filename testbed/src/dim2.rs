//! 2D: `avian2d`, its scenes, its shapes.

use avian2d as avian;
use scenes2d as scenes;

#[path = "idle.rs"]
pub mod idle;
#[path = "overlap.rs"]
mod overlap;
#[path = "space2.rs"]
mod space;
#[path = "world.rs"]
mod world;

pub use world::entries;
