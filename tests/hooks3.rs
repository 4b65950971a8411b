//! Surface velocities in 3D.

use avian::{math::Vector, prelude::ContactManifold};

/// Sets the velocity of the second surface relative to the first.
pub fn set_surface_velocity(manifold: &mut ContactManifold, velocity: Vector) {
    manifold.tangent_velocity = velocity;
}
