//! Tests of the kernel's parts working together, written once for both dimensions.

mod blocks;
mod bounce;
mod carried;
mod crowds;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod distance;
mod extreme;
mod facets;
mod ghosts;
mod golden;
mod heavy;
mod held;
mod hubs;
mod impulses;
mod memory;
mod meshes;
mod passing;
mod physics;
mod pushed;
mod recycling;
mod reload;
mod rest;
mod sim;
mod sound;
mod surfaces;
mod swept_spin;
mod tiles;
mod tunnel;
mod unrest;
