//! The ground of `facets.rs` in 3D.

use avian::{math::Vector, prelude::*};

/// A flat mesh over x = -5 to 0 and x = 0 to 30.
pub fn ground() -> Collider {
    let corners = [-5.0, 0.0, 30.0].into_iter().flat_map(|x| [-3.0, 3.0].map(|z| Vector::new(x, 0.0, z)));
    Collider::trimesh(corners.collect(), vec![[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]])
}

/// The material of each facet: 0 on the left, 1 on the right.
pub fn sides() -> Vec<u8> {
    vec![0, 0, 1, 1]
}
