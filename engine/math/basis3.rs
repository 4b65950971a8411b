//! 3D rotations from basis vectors. `basis2.rs` has the functions of 2D.

use super::{DIM, Matrix3, Quaternion, Vector};

/// A rotation that maps the x axis to `axis`, which may have any length. A zero vector gives the identity.
/// The rotation about `axis` is unspecified, but depends only on `axis`.
pub fn orthonormal_basis_from_vec(axis: Vector) -> Quaternion {
    match axis.try_normalize() {
        Some(x) => {
            let (y, _) = x.any_orthonormal_pair();
            orthonormal_basis([x, y, x.cross(y)])
        }
        None => Quaternion::IDENTITY,
    }
}

/// The rotation that maps the coordinate axes to `axes`, which must be orthonormal and right-handed.
pub fn orthonormal_basis(axes: [Vector; DIM]) -> Quaternion {
    Quaternion::from_mat3(&Matrix3::from_cols(axes[0], axes[1], axes[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_basis_of_a_vector_takes_x_to_it() {
        for axis in [Vector::X, Vector::NEG_X, Vector::Y, Vector::NEG_Z, Vector::new(1.0, -2.0, 3.0)] {
            let basis = orthonormal_basis_from_vec(axis);
            assert!((basis * Vector::X - axis.normalize()).length() < 1e-6, "{axis}");
        }
        assert_eq!(orthonormal_basis_from_vec(Vector::ZERO), Quaternion::IDENTITY);
        let quarter = orthonormal_basis([Vector::Y, Vector::NEG_X, Vector::Z]);
        assert!((quarter * Vector::X - Vector::Y).length() < 1e-6);
    }
}
