//! Orientations of the plane from the axes they turn to. `basis3.rs` is the twin.

use super::{DIM, Vector};
use crate::physics_transform::Rotation;

/// An orientation as joints and rays take it.
pub(crate) type Rot = Rotation;

/// The rotation that takes the x axis to `axis`, which need not have unit length; none for a zero vector.
pub fn orthonormal_basis_from_vec(axis: Vector) -> Rot {
    match axis.try_normalize() {
        Some(axis) => Rotation { cos: axis.x, sin: axis.y },
        None => Rotation::IDENTITY,
    }
}

/// The rotation that takes the coordinate axes to `axes`, which must be orthonormal and right-handed.
pub fn orthonormal_basis(axes: [Vector; DIM]) -> Rot {
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
