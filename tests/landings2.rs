//! The ground of [`landings`](super::landings) in 2D.

use avian::{math::Vector, prelude::*};

/// A line of 21 edges at the height 0.
pub fn mesh() -> Collider {
    let points = (-11..=11_i8).map(|x| Vector::new(-0.37 * f32::from(x), 0.0));
    Collider::polyline(points.collect(), None)
}
