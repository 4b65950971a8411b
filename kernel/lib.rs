//! The simulation kernel: a library of parts for rigid-body physics, in one dimension per package.
//!
//! Everything here is plain data and total functions: no ECS, no globals, no entity, and no clock but for the
//! patience of idle threads. Each part (shapes, bounding-volume trees, manifolds, contact table, colouring,
//! islands, solver, the team that runs it) can be used, tested and measured alone. The same source builds
//! `avian_kernel2d` and `avian_kernel3d`.
//!
//! Lengths are metres, times seconds, masses kilograms, angles radians. The same input gives the same
//! bits on every machine, for every lane width and number of threads: no fused multiply-add, no approximate reciprocal, no
//! libm, no sum across lanes.

#[cfg(not(any(feature = "2d", feature = "3d")))]
compile_error!("choose a dimension: the feature `2d` or `3d`");

pub mod bvh;
pub mod contact;
pub mod data;
pub mod graph;
pub mod manifold;
pub mod math;
pub mod shape;
pub mod solver;
pub mod table;
pub mod team;
