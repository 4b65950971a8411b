//! The simulation kernel: a library of parts for rigid-body physics, in one dimension per package.
//!
//! Every part is plain data and total functions: no ECS, no globals, no entity, and no clock except the spin
//! time of idle threads. Each part can be used, tested and measured alone. The same source builds
//! `avian_kernel2d` and `avian_kernel3d`.
//!
//! | part | content |
//! |---|---|
//! | [`math`], [`data`] | vectors, rotations, SIMD lanes; bit sets, id pools, sets of pairs |
//! | [`shape`], [`manifold`] | shapes with boxes and masses; contact points of two shapes |
//! | [`bvh`] | bounding volume trees, pairs of boxes |
//! | [`table`] | bodies and colliders by id |
//! | [`contact`] | contacts by id, the narrow phase, and `ContactManager`, which changes contacts, colours, islands |
//! | [`graph`] | colours and islands of constraints |
//! | [`solver`] | rows, substeps, poses |
//! | [`query`] | rays, shape casts, nearest points, overlaps: of two shapes, and of all colliders |
//! | [`thread_pool`] | the threads |
//! | [`tuning`] | the constants that tune all of it |
//!
//! Lengths are metres, times seconds, masses kilograms, angles radians. The same input gives the same bits on
//! every machine, for every lane width and number of threads: no fused multiply-add, no approximate
//! reciprocal, no libm, no sum across lanes.
#![cfg_attr(
    feature = "3d",
    doc = concat!(
        "\nA whole step, in the example `falling_box`:\n```\n",
        include_str!("../crates/avian_kernel3d/examples/falling_box.rs"),
        "```",
    )
)]

#[cfg(not(any(feature = "2d", feature = "3d")))]
compile_error!("choose a dimension: the feature `2d` or `3d`");

pub mod bvh;
pub mod ccd;
pub mod contact;
pub mod data;
mod distance;
pub mod graph;
pub mod manifold;
pub mod math;
pub mod query;
pub mod shape;
pub mod solver;
pub mod table;
pub mod thread_pool;
pub mod tuning;
