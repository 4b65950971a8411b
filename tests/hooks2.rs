//! Surface velocities in 2D.

use avian::{math::Vector, prelude::ContactManifold};

/// Sets the velocity of the second surface relative to the first.
pub fn set_surface_velocity(manifold: &mut ContactManifold, velocity: Vector) {
    let tangent = Vector::new(manifold.normal.y, -manifold.normal.x);
    manifold.tangent_speed = tangent.dot(velocity);
}
