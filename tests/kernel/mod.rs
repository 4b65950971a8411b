//! Tests of the kernel's parts working together, written once for both dimensions.

mod arms;
mod blocks;
mod blows;
mod bounce;
mod carried;
#[allow(unused, reason = "its scenes are for `tools/cost.sh`")]
pub mod costs;
mod couplings;
mod crowds;
mod customs;
mod debris;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod distance;
mod doors;
mod edges;
mod extreme;
mod facets;
mod ghosts;
mod golden;
mod heavy;
mod held;
mod hubs;
mod impulses;
mod joint_trees;
mod jointed;
mod joints;
mod memory;
mod meshes;
mod motors;
mod oblique;
mod passing;
mod physics;
mod pushed;
mod ragdolls;
mod recycling;
mod refused;
mod reload;
mod rest;
mod rubbing;
mod sensors;
mod sim;
mod slabs;
mod sound;
mod strikes;
mod struck;
mod surfaces;
#[allow(unused, reason = "its tables are for the documentation")]
pub mod surveys;
mod swept_spin;
mod tiles;
mod tumbling;
mod tunnel;
mod units;
mod unrest;
mod walled;
