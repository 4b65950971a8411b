//! The ground of [`landings`](super::landings) in 3D.

use avian::{math::Vector, prelude::*};

/// A grid of 20 × 20 squares of two triangles at the height 0.
pub fn mesh() -> Collider {
    let corner = |x: u32, z: u32| Vector::new(0.37 * x as f32 - 3.7, 0.0, 0.37 * z as f32 - 3.7);
    let corners = (0..=20).flat_map(|x| (0..=20).map(move |z| corner(x, z))).collect();
    let squares = (0..20).flat_map(|x| (0..20).map(move |z| 21 * x + z));
    let triangles = squares.flat_map(|i| [[i, i + 1, i + 21], [i + 1, i + 22, i + 21]]).collect();
    Collider::trimesh(corners, triangles)
}
