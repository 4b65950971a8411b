//! 2D rotations from basis vectors. `basis3.rs` has the functions of 3D.

use super::{DIM, Vector};
use crate::physics_transform::Rotation;

/// The rotation that maps the x axis to `axis`, which may have any length. A zero vector gives the identity.
pub fn orthonormal_basis_from_vec(axis: Vector) -> Rotation {
    match axis.try_normalize() {
        Some(axis) => Rotation { cos: axis.x, sin: axis.y },
        None => Rotation::IDENTITY,
    }
}

/// The rotation that maps the coordinate axes to `axes`, which must be orthonormal and right-handed.
pub fn orthonormal_basis(axes: [Vector; DIM]) -> Rotation {
    orthonormal_basis_from_vec(axes[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_basis_of_a_vector_takes_x_to_it() {
        let basis = orthonormal_basis_from_vec(Vector::new(0.0, 2.0));
        assert_eq!((basis.cos, basis.sin), (0.0, 1.0));
        let basis = orthonormal_basis_from_vec(Vector::ZERO);
        assert_eq!((basis.cos, basis.sin), (1.0, 0.0));
        let basis = orthonormal_basis([Vector::NEG_X, Vector::NEG_Y]);
        assert_eq!((basis.cos, basis.sin), (-1.0, 0.0));
    }
}
