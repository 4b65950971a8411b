//! The ground of `facets.rs` in 2D.

use avian::{math::Vector, prelude::*};

/// A flat line over x = -5 to 0 and x = 0 to 30.
pub fn ground() -> Collider {
    Collider::polyline([-5.0, 0.0, 30.0].map(|x| Vector::new(x, 0.0)).to_vec(), None)
}

/// The material of each facet: 0 on the left, 1 on the right.
pub fn sides() -> Vec<u8> {
    vec![0, 1]
}
